"""Exact motion of the blocks under a force that is quadratic in time.

A block is ṗ = P + f₁, Ṗ = −c₀ p − c₁ P + f₂. With S(t) its answer to an impulse on P and C = Ṡ + c₁ S:
    p(t) = C p + S P + …,    P(t) = −c₀ S p + (C − c₁ S) P + …
and R₀ = ∫S, R₁ = ∫R₀, R₂ = ∫R₁ give the answer to forces 1, t, t²/2.

Arguments: d with the blocks' c₀ at `c0` and c₁ at `c1`; in w, the force's coefficients of 1, t, t²/2 at `force`,
2 · blocks each.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from flexarm_env.plant.bundles import Blocks, Numbers, Segment

#: 1/k!, for the series of short times; the number of its terms for a |c₀| t² + |c₁| t up to either limit.
INVERSE_FACTORIALS = np.array([1.0 / math.factorial(k) for k in range(18)])
SHORT_ARGUMENT, SHORT_TERMS = 1e-3, 6
LONG_ARGUMENT, LONG_TERMS = 0.125, 12
RESPONSE = 5


@njit(forceinline=True)
def series(d0: float, d1: float, terms: int) -> tuple[float, float, float, float, float]:
    """Compute (C, S/t, R0/t², R1/t³, R2/t⁴) of one block from d₀ = c₀ t², d₁ = c₁ t.

    R₁ and R₂ by their series, the rest from S = t − c₁ R₀ − c₀ R₁ and its integral, which lose nothing in a short t.
    """
    older, old = 0.0, 1.0
    r1, r2 = INVERSE_FACTORIALS[3], INVERSE_FACTORIALS[4]
    for k in range(4, 3 + terms):
        older, old = old, -(d1 * old + d0 * older)
        r1 += old * INVERSE_FACTORIALS[k]
        r2 += old * INVERSE_FACTORIALS[k + 1]
    r0 = 0.5 - d1 * r1 - d0 * r2
    return 1.0 - d0 * r0, 1.0 - d1 * r0 - d0 * r1, r0, r1, r2


@njit(forceinline=True)
def series_argument(c0: float, c1: float, t: float) -> float:
    """Compute |c₀| t² + |c₁ t|, on which the number of terms of the series depends."""
    return abs(c0) * t * t + abs(c1 * t)


@njit(forceinline=True)
def block_response(c0: float, c1: float, t: float) -> tuple[float, float, float, float, float]:
    """Compute (C, S, R0, R1, R2) of one block after time t [s]: the series of a short part of t, doubled until it is t.

    It holds for any damping, without cases, and takes no longer than one sine, cosine and exponential.
    """
    doublings = 0
    while series_argument(c0, c1, t) > LONG_ARGUMENT:
        t *= 0.5
        doublings += 1
    if series_argument(c0, c1, t) > SHORT_ARGUMENT:
        c, s, r0, r1, r2 = series(c0 * t * t, c1 * t, LONG_TERMS)
    else:
        c, s, r0, r1, r2 = series(c0 * t * t, c1 * t, SHORT_TERMS)
    s, r0, r1, r2 = s * t, r0 * t * t, r1 * t * t * t, r2 * t * t * t * t
    for _ in range(doublings):
        r2 += c * r2 + s * r1 + t * (r1 + 0.5 * t * r0)
        r1 += c * r1 + s * r0 + t * r0
        r0 += c * r0 + s * s
        c, s = c * c - c0 * s * s, s * (2.0 * c - c1 * s)
        t *= 2.0
    return c, s, r0, r1, r2


@njit(forceinline=True)
def respond(d: Numbers, c0: int, c1: int, blocks: int, t: float, table: Numbers, first: int) -> None:
    """Write the responses of all blocks after t [s] to table from `first` on."""
    for k in range(blocks):
        c, s, r0, r1, r2 = block_response(d[c0 + k], d[c1 + k], t)
        i = first + RESPONSE * k
        table[i], table[i + 1], table[i + 2], table[i + 3], table[i + 4] = c, s, r0, r1, r2


@njit(forceinline=True)
def advance(d: Numbers, blocks: Blocks, table: Segment, z: Segment, w: Numbers, force: int, out: int) -> None:
    """Write z at the time of the table to w at `out`, which may be the place of z itself."""
    for k in range(blocks.number):
        j = table.first + RESPONSE * k
        c, r, r0 = table.data[j], table.data[j + 1], table.data[j + 2]
        a, b = d[blocks.c0 + k], d[blocks.c1 + k]
        p, q = z.data[z.first + 2 * k], z.data[z.first + 2 * k + 1]
        i = force + 2 * k
        f, g = w[i], w[i + 1]
        new_p = c * p + r * q + f * (r + b * r0) + g * r0
        new_q = (c - b * r) * q - a * (r * p + r0 * f) + r * g
        if blocks.varying:
            r1, r2 = table.data[j + 3], table.data[j + 4]
            f, g = w[i + 2 * blocks.number], w[i + 2 * blocks.number + 1]
            new_p += f * (r0 + b * r1) + g * r1
            new_q += g * r0 - a * r1 * f
            f, g = w[i + 4 * blocks.number], w[i + 4 * blocks.number + 1]
            new_p += f * (r1 + b * r2) + g * r2
            new_q += g * r1 - a * r2 * f
        w[out + 2 * k] = new_p
        w[out + 2 * k + 1] = new_q


@njit(forceinline=True)
def inlined_dot(d: Numbers, row: int, z: Numbers, first: int, count: int) -> float:
    """Compute the product of the row at `row` in d and the numbers at `first` in z, as three independent sums."""
    one, two, three = 0.0, 0.0, 0.0
    i = 0
    while i + 2 < count:
        one += d[row + i] * z[first + i]
        two += d[row + i + 1] * z[first + i + 1]
        three += d[row + i + 2] * z[first + i + 2]
        i += 3
    while i < count:
        one += d[row + i] * z[first + i]
        i += 1
    return one + two + three


@njit
def dot(d: Numbers, row: int, z: Numbers, first: int, count: int) -> float:
    """Compute inlined_dot's product by a call: for places where less code is worth more."""
    return inlined_dot(d, row, z, first, count)
