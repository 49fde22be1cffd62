"""The motion ahead: a copy of it that is brought to any time within a step; arguments as in propagate.py."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.layout import Numbers
from flexarm_env.plant.propagate import LONG_REACH, RESPONSE, advance, reach_of, respond


@njit
def copy_size(blocks: int) -> int:
    """How many numbers a copy of the motion takes (see arrive)."""
    return 1 + (8 + RESPONSE) * blocks


@njit(forceinline=True)
def start_copy(blocks: int, s: Numbers, w: Numbers, force: int, clock: int) -> None:
    """Begin the copy of the motion in w at `clock` anew (see arrive)."""
    w[clock] = 0.0
    for i in range(2 * blocks):
        w[clock + 1 + i] = s[at.HEADER + i]
    for i in range(6 * blocks):
        w[clock + 1 + 2 * blocks + i] = w[force + i]


@njit(forceinline=True)
def arrive(
    d: Numbers, c0: int, c1: int, blocks: int, s: Numbers, w: Numbers, force: int, varying: int, clock: int, t: float
) -> None:  # fmt: skip
    """Bring the copy of the motion in w at `clock` to time t, from where it stands or, if that is long after, from s.

    The copy is its time, z, and the force's coefficients from then on; behind it is room for a table.
    """
    size = 2 * blocks
    z, ahead, table = clock + 1, clock + 1 + size, clock + 1 + 4 * size
    step = t - w[clock]
    for k in range(blocks if step < 0.0 else 0):
        if reach_of(d[c0 + k], d[c1 + k], step) > LONG_REACH:
            start_copy(blocks, s, w, force, clock)
            step = t
            break
    if step == 0.0:
        return
    w[clock] = t
    respond(d, c0, c1, blocks, step, w, table)
    advance(d, c0, c1, blocks, w, table, w, z, w, ahead, varying, z)
    for i in range(ahead, ahead + size if varying else ahead):
        w[i] += step * (w[i + size] + 0.5 * step * w[i + 2 * size])
        w[i + size] += step * w[i + 2 * size]


@njit(forceinline=True)
def rate_of(
    d: Numbers, row: int, c0: int, c1: int, blocks: int, z: Numbers, first: int, w: Numbers, force: int,
    t: float,
) -> float:  # fmt: skip
    """Return row · ż, for z at `first` in array z, t after the force began."""
    total = 0.0
    for k in range(blocks):
        i = 2 * k
        f = w[force + i] + t * (w[force + i + 2 * blocks] + 0.5 * t * w[force + i + 4 * blocks])
        g = w[force + i + 1] + t * (w[force + i + 1 + 2 * blocks] + 0.5 * t * w[force + i + 1 + 4 * blocks])
        p, q = z[first + i], z[first + i + 1]
        total += d[row + i] * (q + f) + d[row + i + 1] * (g - d[c0 + k] * p - d[c1 + k] * q)
    return total


@njit
def value_at(
    d: Numbers, row: int, sign: float, o0: float, o1: float, o2: float, c0: int, c1: int, blocks: int,
    s: Numbers, w: Numbers, force: int, varying: int, clock: int, t: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Return sign · row · z + o₀ + o₁ t + o₂ t²/2 at time t, its rate and the rate's rate; the copy is brought there."""
    arrive(d, c0, c1, blocks, s, w, force, varying, clock, t)
    value, rate, bend = 0.0, 0.0, 0.0
    z, ahead = clock + 1, clock + 1 + 2 * blocks
    for k in range(blocks):
        i = 2 * k
        u, v = d[row + i], d[row + i + 1]
        a, b = d[c0 + k], d[c1 + k]
        p, q = w[z + i], w[z + i + 1]
        p_rate, q_rate = q + w[ahead + i], w[ahead + i + 1] - a * p - b * q
        value += u * p + v * q
        rate += u * p_rate + v * q_rate
        bend += u * (q_rate + w[ahead + i + 2 * blocks]) + v * (w[ahead + i + 1 + 2 * blocks] - a * p_rate - b * q_rate)
    return sign * value + o0 + t * (o1 + 0.5 * t * o2), sign * rate + o1 + t * o2, sign * bend + o2
