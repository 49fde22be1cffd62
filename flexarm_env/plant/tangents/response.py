"""Responses of the blocks and their derivatives by c₀ and c₁."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.event_free_table import LONG_ARGUMENT
from flexarm_env.plant.modes import record
from flexarm_env.plant.propagate import INVERSE_FACTORIALS
from flexarm_env.plant.tangents.bundles import PER_RESPONSE, PER_TABLE

#: Terms of the series of a short time: a derivative loses one order.
TANGENT_TERMS = 13


@njit
def short_response(c0: float, c1: float, t: float, r: Numbers, i: int) -> None:
    """Write C, S and five integrals of S after a short time t [s], then their derivatives by c₀ and c₁, by series."""
    d0, d1 = c0 * t * t, c1 * t
    older, old, older_0, old_0, older_1, old_1 = 0.0, 1.0, 0.0, 0.0, 0.0, 0.0
    r3, r4 = INVERSE_FACTORIALS[5], INVERSE_FACTORIALS[6]
    r3_0, r4_0, r3_1, r4_1 = 0.0, 0.0, 0.0, 0.0
    for k in range(6, 4 + TANGENT_TERMS):
        new_0, new_1 = -(d1 * old_0 + older + d0 * older_0), -(old + d1 * old_1 + d0 * older_1)
        older, old = old, -(d1 * old + d0 * older)
        older_0, old_0, older_1, old_1 = old_0, new_0, old_1, new_1
        r3, r4 = r3 + old * INVERSE_FACTORIALS[k], r4 + old * INVERSE_FACTORIALS[k + 1]
        r3_0, r4_0 = r3_0 + old_0 * INVERSE_FACTORIALS[k], r4_0 + old_0 * INVERSE_FACTORIALS[k + 1]
        r3_1, r4_1 = r3_1 + old_1 * INVERSE_FACTORIALS[k], r4_1 + old_1 * INVERSE_FACTORIALS[k + 1]
    r[i + 6], r[i + 5], r[i + 6 + PER_RESPONSE], r[i + 5 + PER_RESPONSE] = r4, r3, r4_0, r3_0
    r[i + 6 + 2 * PER_RESPONSE], r[i + 5 + 2 * PER_RESPONSE] = r4_1, r3_1
    for g in range(4, -1, -1):  # each from the two of higher order: 1/k! − d₁ (…) − d₀ (…); the last, C, without d₁
        second, third = r[i + g + 1], r[i + g + 2]
        by_0, by_1 = i + PER_RESPONSE + g, i + 2 * PER_RESPONSE + g
        if g == 0:
            r[i], r[by_0], r[by_1] = 1.0 - d0 * third, -third - d0 * r[by_0 + 2], -d0 * r[by_1 + 2]
            continue
        r[i + g] = INVERSE_FACTORIALS[g] - d1 * second - d0 * third
        r[by_0] = -d1 * r[by_0 + 1] - third - d0 * r[by_0 + 2]
        r[by_1] = -second - d1 * r[by_1 + 1] - d0 * r[by_1 + 2]
    power = 1.0
    for g in range(PER_RESPONSE):
        r[i + g] *= power
        r[i + PER_RESPONSE + g] *= power * t * t
        r[i + 2 * PER_RESPONSE + g] *= power * t
        power *= t


@njit
def double_response(c0: float, c1: float, t: float, r: Numbers, i: int) -> None:
    """Double the time t [s] of responses and derivatives."""
    c, s, r0, r1, r2, r3 = r[i], r[i + 1], r[i + 2], r[i + 3], r[i + 4], r[i + 5]
    for by in range(1, 3):
        j = i + by * PER_RESPONSE
        cd, sd, d0, d1, d2, d3, d4 = r[j], r[j + 1], r[j + 2], r[j + 3], r[j + 4], r[j + 5], r[j + 6]
        r[j + 6] += c * d4 + cd * r[i + 6] + s * d3 + sd * r3 + t * (d3 + t / 2.0 * (d2 + t / 3.0 * (d1 + t / 4.0 * d0)))
        r[j + 5] += c * d3 + cd * r3 + s * d2 + sd * r2 + t * (d2 + t / 2.0 * (d1 + t / 3.0 * d0))
        r[j + 4] += c * d2 + cd * r2 + s * d1 + sd * r1 + t * (d1 + t / 2.0 * d0)
        r[j + 3] += c * d1 + cd * r1 + s * d0 + sd * r0 + t * d0
        r[j + 2] += c * d0 + cd * r0 + 2.0 * s * sd
        r[j] = 2.0 * c * cd - 2.0 * c0 * s * sd - (s * s if by == 1 else 0.0)
        r[j + 1] = sd * (2.0 * c - c1 * s) + s * (2.0 * cd - c1 * sd - (s if by == 2 else 0.0))
    r[i + 6] += c * r[i + 6] + s * r3 + t * (r3 + t / 2.0 * (r2 + t / 3.0 * (r1 + t / 4.0 * r0)))
    r[i + 5] += c * r3 + s * r2 + t * (r2 + t / 2.0 * (r1 + t / 3.0 * r0))
    r[i + 4] += c * r2 + s * r1 + t * (r1 + t / 2.0 * r0)
    r[i + 3] += c * r1 + s * r0 + t * r0
    r[i + 2] += c * r0 + s * s
    r[i], r[i + 1] = c * c - c0 * s * s, s * (2.0 * c - c1 * s)


@njit
def tabulate_responses(d: Numbers, n: Places, mode: int, t: float, table: Numbers, first: int) -> None:
    """Write responses and derivatives of all blocks of a mode after t [s] to table from `first` on."""
    here = record(n, mode)
    for k in range(n[at.BLOCKS]):
        c0, c1, short, doublings = d[here + n[at.C0] + k], d[here + n[at.C1] + k], t, 0
        while abs(c0) * short * short + abs(c1) * short > LONG_ARGUMENT:
            short *= 0.5
            doublings += 1
        short_response(c0, c1, short, table, first + PER_TABLE * k)
        for _ in range(doublings):
            double_response(c0, c1, short, table, first + PER_TABLE * k)
            short *= 2.0
