"""The trial motion: a copy of the motion that is advanced to any time within a step."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Line, Motion, Segment
from flexarm_env.plant.propagate import LONGEST_SERIES, RESPONSE, advance, respond, series_argument


@njit
def copy_size(blocks: int) -> int:
    """Count the numbers of a trial motion (see arrive)."""
    return 1 + (8 + RESPONSE) * blocks


@njit(forceinline=True)
def start_copy(m: Motion) -> None:
    """Set the trial motion to the start of the step (see arrive)."""
    w, size = m.w, 2 * m.blocks.number
    w[m.copy] = 0.0
    for i in range(size):
        w[m.copy + 1 + i] = m.s[at.Z_START + i]
    for i in range(3 * size):
        w[m.copy + 1 + size + i] = w[m.force + i]


@njit(forceinline=True)
def arrive(m: Motion, t: float) -> None:
    """Advance the trial motion to time t, from its own time or, if that is much later, from the start of the step.

    It consists of its time, z, and the force's coefficients from that time on; behind it is room for a table.
    """
    d, w, blocks = m.d, m.w, m.blocks
    size = 2 * blocks.number
    z, ahead, table = m.copy + 1, m.copy + 1 + size, m.copy + 1 + 4 * size
    step = t - w[m.copy]
    for k in range(blocks.number if step < 0.0 else 0):
        if series_argument(d[blocks.c0 + k], d[blocks.c1 + k], step) > LONGEST_SERIES:
            start_copy(m)
            step = t
            break
    if step == 0.0:
        return
    w[m.copy] = t
    respond(d, blocks.c0, blocks.c1, blocks.number, step, w, table)
    advance(d, blocks, Segment(w, table), Segment(w, z), w, ahead, z)
    for i in range(ahead, ahead + size if blocks.varying else ahead):
        w[i] += step * (w[i + size] + 0.5 * step * w[i + 2 * size])
        w[i + size] += step * w[i + 2 * size]


@njit(forceinline=True)
def rate_at_end(m: Motion, row: int, t: float) -> float:
    """Compute row · ż of the state at the end of the step, t [s] after the force began."""
    d, w, size = m.d, m.w, 2 * m.blocks.number
    total = 0.0
    for k in range(m.blocks.number):
        i, j = m.force + 2 * k, m.force + 2 * k + 1
        f = w[i] + t * (w[i + size] + 0.5 * t * w[i + 2 * size])
        g = w[j] + t * (w[j + size] + 0.5 * t * w[j + 2 * size])
        p, q = w[m.trial + 2 * k], w[m.trial + 2 * k + 1]
        total += d[row + 2 * k] * (q + f) + d[row + 2 * k + 1] * (g - d[m.blocks.c0 + k] * p - d[m.blocks.c1 + k] * q)
    return total


@njit
def value_at(m: Motion, line: Line, t: float) -> tuple[float, float, float]:
    """Compute a quantity at time t, its first and second derivative; the trial motion is advanced to t."""
    arrive(m, t)
    d, w, size = m.d, m.w, 2 * m.blocks.number
    value, rate, bend = 0.0, 0.0, 0.0
    z, ahead = m.copy + 1, m.copy + 1 + size
    for k in range(m.blocks.number):
        i = 2 * k
        u, v = d[line.row + i], d[line.row + i + 1]
        a, b = d[m.blocks.c0 + k], d[m.blocks.c1 + k]
        p, q = w[z + i], w[z + i + 1]
        p_rate, q_rate = q + w[ahead + i], w[ahead + i + 1] - a * p - b * q
        value += u * p + v * q
        rate += u * p_rate + v * q_rate
        bend += u * (q_rate + w[ahead + i + size]) + v * (w[ahead + i + 1 + size] - a * p_rate - b * q_rate)
    sign, o1, o2 = line.sign, line.o1, line.o2
    return sign * value + line.o0 + t * (o1 + 0.5 * t * o2), sign * rate + o1 + t * o2, sign * bend + o2
