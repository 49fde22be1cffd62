"""The inner product of parts of two arrays, four numbers at a time.

The compiler leaves a sum in its order, one number at a time, since any other order rounds in another way. Here the order is one
that vectors can follow. It is stated, so that the result is the same on every machine.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, overload

from flexarm_env.plant.bundles import Numbers

#: Numbers of a vector, and bytes to whose multiples a place in an array is aligned.
LANES, ALIGNED = 4, 8
PLACE, VECTOR = ir.IntType(64), ir.VectorType(ir.DoubleType(), LANES)


def inner_product(a: Numbers, first_a: int, b: Numbers, first_b: int, count: int) -> float:
    """Compute the sum of a[first_a + i] · b[first_b + i] over i < count; no index is checked where it is compiled.

    Two vectors of sums take the vectors of products in turn, and are added; then those that fill no vector.
    """
    products = [a[first_a + i] * b[first_b + i] for i in range(count)]
    sums = [0.0] * (2 * LANES)
    whole = count - count % LANES
    for i in range(whole):
        sums[i % (2 * LANES)] += products[i]
    lanes = [sums[lane] + sums[LANES + lane] for lane in range(LANES)]
    total = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])
    for product in products[whole:]:
        total += product
    return float(total)


@overload(inner_product, inline="always")
def _compiled(a: Any, first_a: Any, b: Any, first_b: Any, count: Any) -> Any:
    """Use the vectors in compiled kernels."""

    def product(a: Any, first_a: Any, b: Any, first_b: Any, count: Any) -> Any:
        return _by_vectors(a, first_a, b, first_b, count)

    return product


@intrinsic
def _by_vectors(_: Any, a: Any, first_a: Any, b: Any, first_b: Any, count: Any) -> Any:
    return types.float64(a, types.int64, b, types.int64, types.int64), _instructions


def _instructions(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    """Write the instructions of inner_product."""
    a, b = (
        builder.gep(cgutils.create_struct_proxy(signature.args[i])(context, builder, value=arguments[i]).data, [arguments[i + 1]])
        for i in (0, 2)
    )
    count, place = arguments[4], lambda number: ir.Constant(PLACE, number)
    sums = [cgutils.alloca_once_value(builder, ir.Constant(VECTOR, [0.0] * LANES)) for _ in range(2)]
    pairs, whole = builder.and_(count, place(-2 * LANES)), builder.and_(count, place(-LANES))

    def add(total: Any, read: Any, i: Any) -> None:
        product = builder.fmul(read(builder, a, i), read(builder, b, i))
        builder.store(builder.fadd(builder.load(total), product), total)

    with cgutils.for_range_slice(builder, place(0), pairs, place(2 * LANES), inc=True) as (i, _):
        add(sums[0], _vector, i)
        add(sums[1], _vector, builder.add(i, place(LANES)))
    with builder.if_then(builder.icmp_signed("<", pairs, whole)):
        add(sums[0], _vector, pairs)
    vector = builder.fadd(builder.load(sums[0]), builder.load(sums[1]))
    lanes = [builder.extract_element(vector, place(lane)) for lane in range(LANES)]
    both = builder.fadd(builder.fadd(lanes[0], lanes[1]), builder.fadd(lanes[2], lanes[3]))
    total = cgutils.alloca_once_value(builder, both)
    with cgutils.for_range_slice(builder, whole, count, place(1), inc=True) as (i, _):
        add(total, _number, i)
    return builder.load(total)


def _number(builder: Any, first: Any, place: Any) -> Any:
    return builder.load(builder.gep(first, [place]))


def _vector(builder: Any, first: Any, place: Any) -> Any:
    loaded = builder.load(builder.bitcast(builder.gep(first, [place]), VECTOR.as_pointer()))
    loaded.align = ALIGNED
    return loaded
