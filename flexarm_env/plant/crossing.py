"""When a row of the blocks first falls to zero, on the exact motion."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Line, Motion, Point
from flexarm_env.plant.propagate import inlined_dot
from flexarm_env.plant.trial_motion import value_at

#: Shortest interval [s] that is still halved.
SMALLEST_INTERVAL = 1e-13
#: By how much an interval that is not halved any more grows with each one looked at.
COARSER = 1.02


@njit(forceinline=True)
def amplitudes(m: Motion, t: float) -> None:
    """Write how large each block's √(c₀ ṗ² + Ṗ²) can get within t, to w at `sizes`: what its second derivative can reach.

    No passive block lets it grow while the force stays; what a change of the force may add is added. After it, in
    the same measure, what the fourth derivative can reach: (√c₀ + |c₁|)² times as much, and what the change adds.
    """
    d, s, w, blocks = m.d, m.s, m.w, m.blocks.number
    for k in range(blocks):
        i = m.force + 2 * k
        a, b = d[m.blocks.c0 + k], d[m.blocks.c1 + k]
        p, q = s[at.HEADER + 2 * k], s[at.HEADER + 2 * k + 1]
        fast = q + w[i]
        slow = w[i + 1] - a * p - b * q
        stretch = math.sqrt(a)
        fastest = stretch + abs(b)
        size = math.sqrt(a * fast * fast + slow * slow)
        further = 0.0
        if m.blocks.varying:
            f2, g2 = abs(w[i + 4 * blocks]), abs(w[i + 1 + 4 * blocks])
            f1, g1 = abs(w[i + 2 * blocks]) + t * f2, abs(w[i + 1 + 2 * blocks]) + t * g2
            size += t * (stretch * f1 + g1)
            further = fastest * (stretch * f1 + g1) + stretch * f2 + g2
        if b < 0.0:
            size *= math.exp(-b * t)
        w[m.sizes + k] = size
        w[m.sizes + blocks + k] = fastest * fastest * size + further


@njit(forceinline=True)
def curvature_bound(m: Motion, line: Line, t: float) -> float:
    """Bound of |d²(row · z)/dt²| over the next t seconds, from the amplitudes."""
    w, blocks = m.w, m.blocks.number
    total = inlined_dot(m.d, line.weight, w, m.sizes, blocks)
    if m.blocks.varying:
        for i in range(2 * blocks):
            change = abs(w[m.force + i + 2 * blocks]) + t * abs(w[m.force + i + 4 * blocks])
            total += abs(m.d[line.row + i]) * change
    return total


@njit
def chord_error(c0: float, c1: float, length: float) -> float:
    """Return how far a block's part of a row strays from its chord over a length of time, per bound of its curvature.

    Whichever is less: what that bound allows, or, for a fast block, twice the size of its vibration.
    """
    largest = 0.125 * length * length
    if c0 > 0.0:
        largest = min(largest, 2.0 * ((math.sqrt(c0) + abs(c1)) / c0) ** 2)
    return largest * math.exp(max(-c1, 0.0) * length)


@njit(forceinline=True)
def proves(low: Point, high: Point, second: float, fourth: float) -> tuple[bool, bool]:
    """Return (no root, at most one root) as far as ends and bounds of two derivatives prove it over an interval.

    Either derivative's bound limits how far the value strays from its chord, or from the cubic through both ends
    (error of Hermite's interpolation), whose Bézier points bound it.
    """
    width = high.t - low.t
    bend = 0.125 * width * width * second
    if low.value > bend and high.value > bend:
        return True, False
    inner_low, inner_high = low.value + width * low.rate / 3.0, high.value - width * high.rate / 3.0
    chord_error = width**4 * fourth / 384.0
    if min(low.value, inner_low, inner_high, high.value) > chord_error:
        return True, False
    if max(abs(low.rate), abs(high.rate)) > width * second:
        return False, True
    middle, chord_error = 3.0 * (inner_high - inner_low) / width, width**3 * fourth / 124.0
    rising = min(low.rate, middle, high.rate) > chord_error
    return False, rising or max(low.rate, middle, high.rate) < -chord_error


@njit(forceinline=True)
def cubic_root(low: Point, high: Point) -> float:
    """Return how far after `low` the cubic through both ends, above zero at `low` and below at `high`, is about zero."""
    width = high.t - low.t
    slope = (high.value - low.value) / width
    c3 = (low.rate + high.rate - 2.0 * slope) / (width * width)
    c2 = (3.0 * slope - 2.0 * low.rate - high.rate) / width
    t = width * low.value / (low.value - high.value)
    for _ in range(3):
        value = low.value + t * (low.rate + t * (c2 + t * c3))
        rate = low.rate + t * (2.0 * c2 + 3.0 * t * c3)
        new = t - value / rate if rate < 0.0 else t
        if not 0.0 < new < width:
            return t
        t = new
    return t


@njit(forceinline=True)
def point_at(m: Motion, line: Line, t: float) -> Point:
    """Return value and rate at time t; the copy of the motion is brought there."""
    value, rate, _ = value_at(m, line, t)
    return Point(t, value, rate)


@njit(forceinline=True)
def polished_root(m: Motion, line: Line, low: Point, high: Point, end: float, second: float, fourth: float) -> float:
    """Return the one root between two points: by Halley's method from the cubic's root, kept between the ends."""
    earliest, latest = low.t, high.t
    t = low.t + cubic_root(low, high)
    third = math.sqrt(second * fourth)  # of sums of squares, so that it is a bound, too
    for _ in range(60):
        value, rate, bend = value_at(m, line, t)
        if value > 0.0:
            earliest = t
        else:
            latest = t
        new = 0.5 * (earliest + latest)
        if rate < 0.0:
            new = t - value / (rate - 0.5 * bend * value / rate if abs(bend * value) < rate * rate else rate)
        step = abs(new - t)
        left_over = step**3 * (1.5 * second * second - third * rate)  # 6 times rate² times the error after the step
        sure = rate < 0.0 and left_over <= 6e-15 * end * rate * rate
        if sure or step <= 1e-15 * latest or latest - earliest <= 1e-16:
            return min(max(new, earliest), latest)
        t = new if earliest < new < latest else 0.5 * (earliest + latest)
    return t


@njit(forceinline=True)
def first_crossing(m: Motion, line: Line, start: Point, end: Point, second: float, fourth: float) -> float:
    """Return when the value first falls to zero after the start and up to the end, or −1.

    Intervals are halved until bounds of the second and fourth derivatives prove that a half holds no root, or one only:
    none is missed.
    """
    low, high = start, end
    smallest = SMALLEST_INTERVAL + 1e-12 * end.t
    while True:
        width = high.t - low.t
        smallest *= COARSER  # so that a vibration of absurd frequency ends in a coarse answer, not in none
        clear, monotone = proves(low, high, second, fourth)
        if not (clear or monotone) and width > smallest:
            high = point_at(m, line, 0.5 * (low.t + high.t))
            continue
        if not clear and high.value <= 0.0:
            break
        if high.t >= end.t:
            return -1.0
        t = min(high.t + 2.0 * width, end.t)
        low, high = high, point_at(m, line, t) if t < end.t else end
    if low.value <= 0.0:
        return low.t
    return polished_root(m, line, low, high, end.t, second, fourth)
