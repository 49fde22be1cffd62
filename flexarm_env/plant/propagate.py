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
from flexarm_env.plant.inner_product import inner_product

#: 1/k!, for the series of short times: 8 terms are exact to rounding for a |c₀| t² + |c₁| t up to the limit.
INVERSE_FACTORIALS = np.array([1.0 / math.factorial(k) for k in range(18)])
SERIES_TERMS, LONGEST_SERIES = 8, 0.03
RESPONSE = 5


@njit(forceinline=True)
def series_argument(c0: float, c1: float, t: float) -> float:
    """Compute |c₀| t² + |c₁ t|, on which the error of the series depends."""
    return abs(c0) * t * t + abs(c1 * t)


@njit(forceinline=True)
def series(d: Numbers, c0: int, c1: int, blocks: int, t: float, table: Numbers, first: int) -> None:
    """Write the responses of all blocks after a short time t [s]: each order from the two above, 1/k! − c₁ t (…) − c₀ t² (…)."""
    for k in range(blocks):
        d0, d1 = d[c0 + k] * t * t, d[c1 + k] * t
        second, third = INVERSE_FACTORIALS[SERIES_TERMS + 3], INVERSE_FACTORIALS[SERIES_TERMS + 4]
        for order in range(SERIES_TERMS + 2, 4, -1):
            second, third = INVERSE_FACTORIALS[order] - d1 * second - d0 * third, second
        r2 = INVERSE_FACTORIALS[4] - d1 * second - d0 * third
        r1 = INVERSE_FACTORIALS[3] - d1 * r2 - d0 * second
        r0 = 0.5 - d1 * r1 - d0 * r2
        table[first + blocks + k] = t * (1.0 - d1 * r0 - d0 * r1)
        table[first + 2 * blocks + k] = t * t * r0
        table[first + 3 * blocks + k] = t * t * t * r1
        table[first + 4 * blocks + k] = t * t * t * t * r2


@njit(forceinline=True)
def respond(d: Numbers, c0: int, c1: int, blocks: int, t: float, table: Numbers, first: int) -> None:
    """Write the responses (RESPONSE, blocks) of all blocks after t [s] to table from `first` on.

    The series of a short part of t, doubled until it is t, all blocks in step: it holds for any damping, without cases, and the
    compiler takes several blocks at once. C is 1 − c₀ R₀, which loses nothing in a slow block.
    """
    most0, most1 = 0.0, 0.0
    for k in range(blocks):
        most0, most1 = max(most0, abs(d[c0 + k])), max(most1, abs(d[c1 + k]))
    doublings = 0
    while series_argument(most0, most1, t) > LONGEST_SERIES:
        t *= 0.5
        doublings += 1
    series(d, c0, c1, blocks, t, table, first)
    for _ in range(doublings):
        for k in range(blocks):
            a, b, i = d[c0 + k], d[c1 + k], first + blocks + k
            s, r0, r1, r2 = table[i], table[i + blocks], table[i + 2 * blocks], table[i + 3 * blocks]
            c = 1.0 - a * r0
            table[i + 3 * blocks] = r2 + c * r2 + s * r1 + t * (r1 + 0.5 * t * r0)
            table[i + 2 * blocks] = r1 + c * r1 + s * r0 + t * r0
            table[i + blocks] = r0 + c * r0 + s * s
            table[i] = s * (2.0 * c - b * s)
        t *= 2.0
    for k in range(blocks):
        table[first + k] = 1.0 - d[c0 + k] * table[first + 2 * blocks + k]


@njit(forceinline=True)
def advance(d: Numbers, blocks: Blocks, table: Segment, z: Segment, w: Numbers, force: int, out: int) -> None:
    """Write z at the time of the table to w at `out`, which may be the place of z itself."""
    number = blocks.number
    for k in range(number):
        j, i = table.first + k, force + 2 * k
        c, r, r0 = table.data[j], table.data[j + number], table.data[j + 2 * number]
        a, b = d[blocks.c0 + k], d[blocks.c1 + k]
        p, q = z.data[z.first + 2 * k], z.data[z.first + 2 * k + 1]
        f, g = w[i], w[i + 1]
        w[out + 2 * k] = c * p + r * q + f * (r + b * r0) + g * r0
        w[out + 2 * k + 1] = (c - b * r) * q - a * (r * p + r0 * f) + r * g
    for k in range(number if blocks.varying else 0):
        j, i = table.first + 2 * number + k, force + 2 * number + 2 * k
        r0, r1, r2 = table.data[j], table.data[j + number], table.data[j + 2 * number]
        a, b = d[blocks.c0 + k], d[blocks.c1 + k]
        f, g, f2, g2 = w[i], w[i + 1], w[i + 2 * number], w[i + 2 * number + 1]
        w[out + 2 * k] += f * (r0 + b * r1) + g * r1 + f2 * (r1 + b * r2) + g2 * r2
        w[out + 2 * k + 1] += g * r0 - a * r1 * f + g2 * r1 - a * r2 * f2


@njit
def dot(d: Numbers, row: int, z: Numbers, first: int, count: int) -> float:
    """Compute an inner product by a call: for places where less code is worth more."""
    return inner_product(d, row, z, first, count)
