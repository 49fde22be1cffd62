"""Exact motion of the blocks under a force that is quadratic in time, and the first crossing of a row.

A block is ṗ = P + f₁, Ṗ = −c₀ p − c₁ P + f₂. With S(t) its answer to an impulse on P and C = Ṡ + c₁ S:
    p(t) = C p + S P + …,    P(t) = −c₀ S p + (C − c₁ S) P + …
and R₀ = ∫S, R₁ = ∫R₀, R₂ = ∫R₁ give the answer to forces 1, t, t²/2.

Arguments: d with the blocks' c₀ at `c0` and c₁ at `c1`; z in s from HEADER on; in w, the force's coefficients of 1, t, t²/2 at
`force`, 2 · blocks each. A row is at `row` in d.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from flexarm_env.plant.layout import HEADER, Numbers

#: 1/k!, for the series of short times, and how many terms it needs below either reach of |c₀| t² + |c₁| t.
INVERSE_FACTORIALS = np.array([1.0 / math.factorial(k) for k in range(18)])
SHORT_REACH, SHORT_TERMS = 1e-3, 6
LONG_REACH, LONG_TERMS = 0.125, 12
SMALLEST_INTERVAL = 1e-13
RESPONSE = 5


@njit
def series(d0: float, d1: float, terms: int) -> tuple[float, float, float, float, float]:
    """Return (C, S/t, R0/t², R1/t³, R2/t⁴) of one block from d₀ = c₀ t², d₁ = c₁ t.

    R₁ and R₂ by their series, the rest from S = t − c₁ R₀ − c₀ R₁ and its integral, which lose nothing where t is short.
    """
    older, old = 0.0, 1.0
    r1, r2 = INVERSE_FACTORIALS[3], INVERSE_FACTORIALS[4]
    for k in range(4, 3 + terms):
        older, old = old, -(d1 * old + d0 * older)
        r1 += old * INVERSE_FACTORIALS[k]
        r2 += old * INVERSE_FACTORIALS[k + 1]
    r0 = 0.5 - d1 * r1 - d0 * r2
    return 1.0 - d0 * r0, 1.0 - d1 * r0 - d0 * r1, r0, r1, r2


@njit
def block_response(c0: float, c1: float, t: float) -> tuple[float, float, float, float, float]:
    """Return (C, S, R0, R1, R2) of one block after time t [s]: the series of a short part of t, doubled until it is t.

    There are no cases: it holds for any damping, and takes no longer than one sine, cosine and exponential would.
    """
    doublings = 0
    while abs(c0) * t * t + abs(c1) * t > LONG_REACH:
        t *= 0.5
        doublings += 1
    if abs(c0) * t * t + abs(c1) * t > SHORT_REACH:
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


@njit
def respond(d: Numbers, c0: int, c1: int, blocks: int, t: float, table: Numbers, at: int) -> None:
    """Fill table from `at` on with the responses of all blocks after t."""
    for k in range(blocks):
        c, s, r0, r1, r2 = block_response(d[c0 + k], d[c1 + k], t)
        i = at + RESPONSE * k
        table[i], table[i + 1], table[i + 2], table[i + 3], table[i + 4] = c, s, r0, r1, r2


@njit
def advance(
    d: Numbers, c0: int, c1: int, blocks: int, table: Numbers, at: int, s: Numbers, w: Numbers,
    force: int, varying: int, out: int,
) -> None:  # fmt: skip
    """Write to w at `out` where z gets to by the time of the table at `at`."""
    for k in range(blocks):
        j = at + RESPONSE * k
        c, r, r0 = table[j], table[j + 1], table[j + 2]
        a, b = d[c0 + k], d[c1 + k]
        p, q = s[HEADER + 2 * k], s[HEADER + 2 * k + 1]
        i = force + 2 * k
        f, g = w[i], w[i + 1]
        new_p = c * p + r * q + f * (r + b * r0) + g * r0
        new_q = (c - b * r) * q - a * (r * p + r0 * f) + r * g
        if varying:
            r1, r2 = table[j + 3], table[j + 4]
            f, g = w[i + 2 * blocks], w[i + 2 * blocks + 1]
            new_p += f * (r0 + b * r1) + g * r1
            new_q += g * r0 - a * r1 * f
            f, g = w[i + 4 * blocks], w[i + 4 * blocks + 1]
            new_p += f * (r1 + b * r2) + g * r2
            new_q += g * r1 - a * r2 * f
        w[out + 2 * k] = new_p
        w[out + 2 * k + 1] = new_q


@njit(forceinline=True)
def dot(d: Numbers, row: int, z: Numbers, at: int, count: int) -> float:
    """Return the row at `row` in d times the numbers at `at` in z, as three sums that need not wait for each other."""
    one, two, three = 0.0, 0.0, 0.0
    i = 0
    while i + 2 < count:
        one += d[row + i] * z[at + i]
        two += d[row + i + 1] * z[at + i + 1]
        three += d[row + i + 2] * z[at + i + 2]
        i += 3
    while i < count:
        one += d[row + i] * z[at + i]
        i += 1
    return one + two + three


@njit
def rate_of(
    d: Numbers, row: int, c0: int, c1: int, blocks: int, z: Numbers, at: int, w: Numbers, force: int,
    t: float,
) -> float:  # fmt: skip
    """Return row · ż, for z at `at` in array z, t after the force began."""
    total = 0.0
    for k in range(blocks):
        i = 2 * k
        f = w[force + i] + t * (w[force + i + 2 * blocks] + 0.5 * t * w[force + i + 4 * blocks])
        g = w[force + i + 1] + t * (w[force + i + 1 + 2 * blocks] + 0.5 * t * w[force + i + 1 + 4 * blocks])
        p, q = z[at + i], z[at + i + 1]
        total += d[row + i] * (q + f) + d[row + i + 1] * (g - d[c0 + k] * p - d[c1 + k] * q)
    return total


@njit
def amplitudes(
    d: Numbers, c0: int, c1: int, blocks: int, s: Numbers, w: Numbers, force: int, varying: int,
    t: float, out: int,
) -> None:  # fmt: skip
    """Write how large each block's √(c₀ ṗ² + Ṗ²) can get within t, to w at `out`: what its second derivative can reach.

    No passive block lets it grow while the force stays; what a change of the force may add is added. After it, in
    the same measure, what the fourth derivative can reach: (√c₀ + |c₁|)² times as much, and what the change adds.
    """
    for k in range(blocks):
        i = 2 * k
        a, b = d[c0 + k], d[c1 + k]
        p, q = s[HEADER + i], s[HEADER + i + 1]
        fast = q + w[force + i]
        slow = w[force + i + 1] - a * p - b * q
        stretch = math.sqrt(a)
        fastest = stretch + abs(b)
        size = math.sqrt(a * fast * fast + slow * slow)
        further = 0.0
        if varying:
            f2, g2 = abs(w[force + i + 4 * blocks]), abs(w[force + i + 1 + 4 * blocks])
            f1, g1 = abs(w[force + i + 2 * blocks]) + t * f2, abs(w[force + i + 1 + 2 * blocks]) + t * g2
            size += t * (stretch * f1 + g1)
            further = fastest * (stretch * f1 + g1) + stretch * f2 + g2
        if b < 0.0:
            size *= math.exp(-b * t)
        w[out + k] = size
        w[out + blocks + k] = fastest * fastest * size + further


@njit(forceinline=True)
def curvature_bound(
    d: Numbers, row: int, weight: int, blocks: int, w: Numbers, size: int, force: int, varying: int,
    t: float,
) -> float:  # fmt: skip
    """Bound of |d²(row · z)/dt²| over the next t seconds, from the amplitudes at `size`."""
    total = dot(d, weight, w, size, blocks)
    if varying:
        for i in range(2 * blocks):
            total += abs(d[row + i]) * (abs(w[force + i + 2 * blocks]) + t * abs(w[force + i + 4 * blocks]))
    return total


@njit
def value_at(
    d: Numbers, row: int, sign: float, o0: float, o1: float, o2: float, c0: int, c1: int, blocks: int,
    s: Numbers, w: Numbers, force: int, varying: int, t: float,
) -> tuple[float, float]:  # fmt: skip
    """Return (value, rate) of sign · row · z + o₀ + o₁ t + o₂ t²/2 at time t."""
    value, rate = 0.0, 0.0
    for k in range(blocks):
        i = 2 * k
        u, v = d[row + i], d[row + i + 1]
        if u == 0.0 and v == 0.0:
            continue
        a, b = d[c0 + k], d[c1 + k]
        c, r, r0, r1, r2 = block_response(a, b, t)
        p, q = s[HEADER + i], s[HEADER + i + 1]
        f, g = w[force + i], w[force + i + 1]
        new_p = c * p + r * q + f * (r + b * r0) + g * r0
        new_q = (c - b * r) * q - a * (r * p + r0 * f) + r * g
        if varying:
            f1, g1 = w[force + i + 2 * blocks], w[force + i + 1 + 2 * blocks]
            f2, g2 = w[force + i + 4 * blocks], w[force + i + 1 + 4 * blocks]
            new_p += f1 * (r0 + b * r1) + g1 * r1 + f2 * (r1 + b * r2) + g2 * r2
            new_q += g1 * r0 - a * r1 * f1 + g2 * r1 - a * r2 * f2
            f += t * (f1 + 0.5 * t * f2)
            g += t * (g1 + 0.5 * t * g2)
        value += u * new_p + v * new_q
        rate += u * (new_q + f) + v * (g - a * new_p - b * new_q)
    return sign * value + o0 + t * (o1 + 0.5 * t * o2), sign * rate + o1 + t * o2


@njit
def proves(
    width: float, value_low: float, rate_low: float, value_high: float, rate_high: float,
    second: float, fourth: float,
) -> tuple[bool, bool]:  # fmt: skip
    """Return (no root, at most one root) as far as values, rates and bounds of two derivatives prove it over an interval.

    Either derivative's bound limits how far the value strays from its chord, or from the cubic through both ends
    (error of Hermite's interpolation), whose Bézier points bound it.
    """
    bend = 0.125 * width * width * second
    if value_low > bend and value_high > bend:
        return True, False
    inner_low, inner_high = value_low + width * rate_low / 3.0, value_high - width * rate_high / 3.0
    stray = width**4 * fourth / 384.0
    if min(value_low, inner_low, inner_high, value_high) > stray:
        return True, False
    if max(abs(rate_low), abs(rate_high)) > width * second:
        return False, True
    middle, stray = 3.0 * (inner_high - inner_low) / width, width**3 * fourth / 124.0
    rising = min(rate_low, middle, rate_high) > stray
    return False, rising or max(rate_low, middle, rate_high) < -stray


@njit
def cubic_root(width: float, value_low: float, rate_low: float, value_high: float, rate_high: float) -> float:
    """Return where the cubic through both ends, above zero at 0 and below at `width`, is about zero."""
    slope = (value_high - value_low) / width
    c3 = (rate_low + rate_high - 2.0 * slope) / (width * width)
    c2 = (3.0 * slope - 2.0 * rate_low - rate_high) / width
    t = width * value_low / (value_low - value_high)
    for _ in range(3):
        value = value_low + t * (rate_low + t * (c2 + t * c3))
        rate = rate_low + t * (2.0 * c2 + 3.0 * t * c3)
        new = t - value / rate if rate < 0.0 else t
        if not 0.0 < new < width:
            return t
        t = new
    return t


@njit
def first_crossing(
    d: Numbers, row: int, sign: float, o0: float, o1: float, o2: float, c0: int, c1: int, blocks: int,
    s: Numbers, w: Numbers, force: int, varying: int, start: float, end: float, at_start: float,
    rate_start: float, at_end: float, rate_end: float, second: float, fourth: float,
) -> float:  # fmt: skip
    """Return when the value first falls to zero in (start, end], or −1.

    Intervals are halved until bounds of derivatives prove that a half holds no root, or one only: none is missed.
    """
    low, value_low, rate_low = start, at_start, rate_start
    high, value_high, rate_high = end, at_end, rate_end
    while True:
        width = high - low
        clear, monotone = proves(width, value_low, rate_low, value_high, rate_high, second, fourth)
        if not (clear or monotone) and width > SMALLEST_INTERVAL + 1e-12 * end:
            high = 0.5 * (low + high)
            value_high, rate_high = value_at(d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, varying, high)
            continue
        if not clear and value_high <= 0.0:
            break
        if high >= end:
            return -1.0
        low, value_low, rate_low = high, value_high, rate_high
        high = min(high + 2.0 * width, end)
        if high < end:
            value_high, rate_high = value_at(d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, varying, high)
        else:
            value_high, rate_high = at_end, rate_end
    if value_low <= 0.0:
        return low
    t = low + cubic_root(high - low, value_low, rate_low, value_high, rate_high)
    for _ in range(60):  # Newton's method, kept between the ends
        value, rate = value_at(d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, varying, t)
        if value > 0.0:
            low = t
        else:
            high = t
        new = t - value / rate if rate < 0.0 else 0.5 * (low + high)
        left_over = (new - t) ** 2 * second  # twice the rate times the error that Newton's step leaves
        if left_over <= -1e-15 * end * rate or abs(new - t) <= 1e-15 * high or high - low <= 1e-16:
            return min(max(new, low), high)
        t = new if low < new < high else 0.5 * (low + high)
    return t
