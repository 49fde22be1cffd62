"""When a row of the blocks first falls to zero, on the exact motion; arguments as in propagate.py."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.ahead import value_at
from flexarm_env.plant.layout import Numbers
from flexarm_env.plant.propagate import inlined_dot

#: Shortest interval [s] that is still halved.
SMALLEST_INTERVAL = 1e-13
#: By how much an interval that is not halved any more grows with each one looked at.
COARSER = 1.02


@njit(forceinline=True)
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
        p, q = s[at.HEADER + i], s[at.HEADER + i + 1]
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
    total = inlined_dot(d, weight, w, size, blocks)
    if varying:
        for i in range(2 * blocks):
            total += abs(d[row + i]) * (abs(w[force + i + 2 * blocks]) + t * abs(w[force + i + 4 * blocks]))
    return total


@njit
def stray(c0: float, c1: float, length: float) -> float:
    """Return how far a block's part of a row strays from its chord over a length of time, per bound of its curvature.

    Whichever is less: what that bound allows, or, for a fast block, twice the size of its vibration.
    """
    largest = 0.125 * length * length
    if c0 > 0.0:
        largest = min(largest, 2.0 * ((math.sqrt(c0) + abs(c1)) / c0) ** 2)
    return largest * math.exp(max(-c1, 0.0) * length)


@njit(forceinline=True)
def proves(
    width: float, value_low: float, rate_low: float, value_high: float, rate_high: float,
    second: float, fourth: float,
) -> tuple[bool, bool]:  # fmt: skip
    """Return (no root, at most one root) as far as ends and bounds of two derivatives prove it over an interval.

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


@njit(forceinline=True)
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


@njit(forceinline=True)
def first_crossing(
    d: Numbers, row: int, sign: float, o0: float, o1: float, o2: float, c0: int, c1: int, blocks: int,
    s: Numbers, w: Numbers, force: int, varying: int, clock: int, start: float, end: float, at_start: float,
    rate_start: float, at_end: float, rate_end: float, second: float, fourth: float,
) -> float:  # fmt: skip
    """Return when the value first falls to zero in (start, end], or −1.

    Intervals are halved until bounds of derivatives prove that a half holds no root, or one only: none is missed.
    """
    low, value_low, rate_low = start, at_start, rate_start
    high, value_high, rate_high = end, at_end, rate_end
    smallest = SMALLEST_INTERVAL + 1e-12 * end
    while True:
        width = high - low
        smallest *= COARSER  # so that a vibration of absurd frequency ends in a coarse answer, not in none
        clear, monotone = proves(width, value_low, rate_low, value_high, rate_high, second, fourth)
        if not (clear or monotone) and width > smallest:
            high = 0.5 * (low + high)
            value_high, rate_high, _ = value_at(d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, varying, clock, high)
            continue
        if not clear and value_high <= 0.0:
            break
        if high >= end:
            return -1.0
        low, value_low, rate_low = high, value_high, rate_high
        high = min(high + 2.0 * width, end)
        if high < end:
            value_high, rate_high, _ = value_at(d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, varying, clock, high)
        else:
            value_high, rate_high = at_end, rate_end
    if value_low <= 0.0:
        return low
    t = low + cubic_root(high - low, value_low, rate_low, value_high, rate_high)
    third = math.sqrt(second * fourth)  # of sums of squares, so that it is a bound, too
    for _ in range(60):  # Halley's method, kept between the ends
        value, rate, bend = value_at(d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, varying, clock, t)
        if value > 0.0:
            low = t
        else:
            high = t
        new = 0.5 * (low + high)
        if rate < 0.0:
            new = t - value / (rate - 0.5 * bend * value / rate if abs(bend * value) < rate * rate else rate)
        step = abs(new - t)
        left_over = step**3 * (1.5 * second * second - third * rate)  # 6 times rate² times the error after the step
        sure = rate < 0.0 and left_over <= 6e-15 * end * rate * rate
        if sure or step <= 1e-15 * high or high - low <= 1e-16:
            return min(max(new, low), high)
        t = new if low < new < high else 0.5 * (low + high)
    return t
