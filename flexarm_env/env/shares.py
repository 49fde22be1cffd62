"""Shares of the arms that threads claim, without the interpreter between two shares.

Waking a thread takes some ten microseconds, half of the time of a step of a thousand arms. A helper therefore watches for
the next step for a while, and goes to sleep only if none follows. Threads claim shares by atomic instructions: the caller
does the work of a late helper. Each thread begins at its own end, so that an arm mostly stays in the cache of one core.
The functions stand alone in this file, so that numba's cache, which detects edits of this file only, is never out of date.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import boolean, float32, float64, int64, njit, types, uint64
from numba.extending import intrinsic
from numpy.typing import NDArray

#: Numbers in a line of the processor's cache.
LINE = 8
# --- places of a pool's numbers: those that different threads write are in different lines
STEP, DONE, AWAKE = 0, LINE, 2 * LINE

#: How often a helper polls for the next step before it goes to sleep: about 0.1 ms.
POLLS = 500_000

FLOATS, PLACES = float64[::1], int64[::1]
#: Types of the kernel that moves arms on (plant.batch.step_batch), and of the one that rewards and observes them
#: (env.kernel.after_step).
MOVE = types.FunctionType(types.none(FLOATS, PLACES, PLACES, int64, int64, int64))
OBSERVE = types.FunctionType(types.none(FLOATS, PLACES, uint64[::1], float32[:, ::1], int64, int64))


class Arms(NamedTuple):
    """Arrays on which the kernels of a batch of arms work.

    Attributes:
        arena: all numbers of the arms.
        layout: of the plant's constants, see plant.layout.
        plant_offsets: of the plant's quantities in the arena, see plant.batch.
        env_offsets: of the environment's quantities in the arena, see env.layout.
        rng_keys: (arms,) of the episodes' draws.
        observations: (arms, signals + 1), to be written.
    """

    arena: NDArray[np.float64]
    layout: NDArray[np.int64]
    plant_offsets: NDArray[np.int64]
    env_offsets: NDArray[np.int64]
    rng_keys: NDArray[np.uint64]
    observations: NDArray[np.float32]


ARMS = types.NamedTuple([FLOATS, PLACES, PLACES, PLACES, uint64[::1], float32[:, ::1]], Arms)


def _pointer(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    array = context.make_array(signature.args[0])(context, builder, arguments[0])
    return builder.gep(array.data, [arguments[1]])


@intrinsic
def atomic_load(_, pool, place):
    """Read pool[place] as other threads last wrote it."""

    def generate(context, builder, signature, arguments):
        return builder.load_atomic(_pointer(context, builder, signature, arguments), "seq_cst", 8)

    return int64(pool, types.intp), generate


@intrinsic
def atomic_add(_, pool, place, value):
    """Add to pool[place], at once for all threads, and return the old value."""

    def generate(context, builder, signature, arguments):
        return builder.atomic_rmw("add", _pointer(context, builder, signature, arguments), arguments[2], "seq_cst")

    return int64(pool, types.intp, int64), generate


@intrinsic
def atomic_exchange(_, pool, place, value):
    """Set pool[place], at once for all threads, and return the old value."""

    def generate(context, builder, signature, arguments):
        return builder.atomic_rmw("xchg", _pointer(context, builder, signature, arguments), arguments[2], "seq_cst")

    return int64(pool, types.intp, int64), generate


@intrinsic
def compare_and_swap(_, pool, place, old, new):
    """Set pool[place] to the new value if it is the old one; return whether it was."""

    def generate(context, builder, signature, arguments):
        place = _pointer(context, builder, signature, arguments)
        result = builder.cmpxchg(place, arguments[2], arguments[3], "seq_cst", "seq_cst")
        return builder.extract_value(result, 1)

    return boolean(pool, types.intp, int64, int64), generate


@njit((int64(int64)), cache=True)
def first_claim(threads):
    """Locate the first share's claim in a pool."""
    return AWAKE + LINE * threads


@njit((PLACES, int64), cache=True, nogil=True)
def begin_step(pool, first):
    """Begin a step, with the first share, at pool[first], already claimed."""
    atomic_exchange(pool, DONE, 0)
    pool[first] += 1
    atomic_add(pool, STEP, 1)


@njit(boolean(PLACES, int64), cache=True, nogil=True)
def wake(pool, part):
    """Mark helper `part` as awake; return whether it was asleep."""
    return atomic_exchange(pool, AWAKE + LINE * part, 1) == 0


@njit(int64(PLACES, int64, int64), cache=True, nogil=True)
def finish_share(pool, first, last):
    """Count one share as done, and claim the first unclaimed one of those with claims in pool[first:last].

    Return its place there, or -1.
    """
    atomic_add(pool, DONE, 1)
    step = atomic_load(pool, STEP)
    for place in range(first, last):
        if compare_and_swap(pool, place, step - 1, step):
            return place
    return -1


@njit(boolean(PLACES, int64), cache=True, nogil=True)
def wait_for_shares(pool, shares):
    """Wait up to about 0.1 ms until `shares` shares are done; return whether they are."""
    polls = 0
    while atomic_load(pool, DONE) < shares and polls < POLLS:
        polls += 1
    return polls < POLLS


@njit((MOVE, OBSERVE, ARMS, PLACES, PLACES, int64, int64), cache=True, nogil=True)
def work_on_shares(move, observe, arms, pool, bounds, threads, part):
    """Move on the shares that nobody has claimed, step after step, until no step follows for a while.

    Args:
        move: moves arms on.
        observe: rewards and observes them.
        arms: Arms.
        pool: number of the step, finished shares, awake threads, claims.
        bounds: (shares + 1,): share i is the arms from bounds[i] to bounds[i + 1] - 1.
        threads: number of them.
        part: number of this one, from 1 up.
    """
    shares, awake = len(bounds) - 1, AWAKE + LINE * part
    last = shares * (part + 1) // threads - 1
    atomic_exchange(pool, awake, 1)
    while True:
        step = atomic_load(pool, STEP)
        for i in range(shares):
            share = (last - i) % shares
            if compare_and_swap(pool, first_claim(threads) + share, step - 1, step):
                move(arms.arena, arms.layout, arms.plant_offsets, bounds[share], bounds[share + 1], part)
                observe(arms.arena, arms.env_offsets, arms.rng_keys, arms.observations, bounds[share], bounds[share + 1])
                atomic_add(pool, DONE, 1)
        polls = 0
        while atomic_load(pool, STEP) == step and polls < POLLS:
            polls += 1
        if polls == POLLS:
            atomic_exchange(pool, awake, 0)
            if atomic_load(pool, STEP) == step:  # else a step began before it was seen that this thread sleeps
                return
            atomic_exchange(pool, awake, 1)
