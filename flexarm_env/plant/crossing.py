"""The first zero of a quantity along the exact motion."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant.bundles import Line, Motion, Point, Segment
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.propagate import dot
from flexarm_env.plant.trial_motion import value_at

#: Shortest interval [s] that is halved.
SMALLEST_INTERVAL = 1e-13
#: Growth of that shortest interval per interval searched.
COARSER = 1.02


@njit(forceinline=True)
def amplitudes(m: Motion, z: Segment, force: int, t: float, out: int) -> None:
    """Bound each block's √(c₀ ṗ² + Ṗ²) within t [s] from z on, the measure of its second derivative; written to w at `out`.

    Under a constant force it does not grow in a passive block; the effect of a change of the force is added. Behind it, in the
    same measure, stand bounds of the fourth derivative: (√c₀ + |c₁|)² times as large, and the effect of the change.
    """
    d, w, blocks = m.d, m.w, m.blocks.number
    for k in range(blocks):
        i = force + 2 * k
        a, b = d[m.blocks.c0 + k], d[m.blocks.c1 + k]
        p, q = z.data[z.first + 2 * k], z.data[z.first + 2 * k + 1]
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
        w[out + k] = size
        w[out + blocks + k] = fastest * fastest * size + further


@njit(forceinline=True)
def derivative_bounds(m: Motion, line: Line, force: int, t: float, sizes: int) -> tuple[float, float]:
    """Bound the second and the fourth derivative of a quantity over the next t [s], from the amplitudes."""
    w, blocks = m.w, m.blocks.number
    second = inner_product(m.d, line.weight, w, sizes, blocks) + abs(line.o2)
    if m.blocks.varying:
        for i in range(2 * blocks):
            change = abs(w[force + i + 2 * blocks]) + t * abs(w[force + i + 4 * blocks])
            second += abs(m.d[line.row + i]) * change
    return second, dot(m.d, line.weight, w, sizes + blocks, blocks)


@njit(forceinline=True)
def bounds_from_trial(m: Motion, line: Line, t: float) -> tuple[float, float]:
    """Bound both derivatives over the t [s] that follow the trial motion: what has decayed by then bends nothing."""
    size = 2 * m.blocks.number
    ahead, sizes = m.copy + 1 + size, m.sizes + size
    amplitudes(m, Segment(m.w, m.copy + 1), ahead, t, sizes)
    return derivative_bounds(m, line, ahead, t, sizes)


@njit
def chord_error(c0: float, c1: float, length: float) -> float:
    """Bound the error of the chord of a block's part of a row over a time [s], per unit of the bound on its curvature.

    The smaller of two bounds: by the curvature, and, for a fast block, by twice the size of its vibration, or by the size of its
    decay, beside which it moves evenly.
    """
    largest = 0.125 * length * length
    if c0 > 0.0:
        largest = min(largest, 2.0 * ((math.sqrt(c0) + abs(c1)) / c0) ** 2)
    elif c0 == 0.0 and c1 > 0.0:
        largest = min(largest, 1.0 / (c1 * c1))
    return largest * math.exp(max(-c1, 0.0) * length)


@njit(forceinline=True)
def proves(low: Point, high: Point, second: float, fourth: float) -> tuple[bool, bool]:
    """Prove that an interval holds no root, or at most one, from its ends and the bounds of two derivatives.

    The second derivative bounds the error of the chord. The fourth bounds that of the cubic through both ends (error of Hermite
    interpolation), and the cubic's Bézier points bound the cubic.

    Returns:
        (no root, at most one root).
    """
    width = high.t - low.t
    bend = 0.125 * width * width * second
    if low.value > bend and high.value > bend:
        return True, False
    inner_low, inner_high = low.value + width * low.rate / 3.0, high.value - width * high.rate / 3.0
    error = width**4 * fourth / 384.0
    if min(low.value, inner_low, inner_high, high.value) > error:
        return True, False
    if max(abs(low.rate), abs(high.rate)) > width * second:
        return False, True
    middle, error = 3.0 * (inner_high - inner_low) / width, width**3 * fourth / 124.0
    rising = min(low.rate, middle, high.rate) > error
    return False, rising or max(low.rate, middle, high.rate) < -error


@njit(forceinline=True)
def cubic_root(low: Point, high: Point) -> float:
    """Find the time after `low` of the zero of the cubic through both ends, above zero at `low` and below at `high`."""
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
    """Compute value and rate at time t, to which the trial motion is advanced."""
    value, rate, _ = value_at(m, line, t)
    return Point(t, value, rate)


@njit(forceinline=True)
def polished_root(m: Motion, line: Line, low: Point, high: Point, end: float, second: float, fourth: float) -> float:
    """Find the only root between two points: Halley's method from the cubic's root, kept between the ends."""
    earliest, latest = low.t, high.t
    t = low.t + cubic_root(low, high)
    third = math.sqrt(second * fourth)  # a bound, too: the second and fourth are sums of squares
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
    """Find the first time in (start, end] at which the value falls to zero, or −1.

    Intervals are halved until the bounds of the second and fourth derivatives prove that a part holds no root or only one, so no
    root is missed.
    """
    low, high = start, end
    smallest = SMALLEST_INTERVAL + 1e-12 * end.t
    while True:
        width = high.t - low.t
        smallest *= COARSER  # so that the search ends under a vibration of absurd frequency, with a coarse answer
        clear, monotone = proves(low, high, second, fourth)
        if not (clear or monotone) and width > smallest:
            high = point_at(m, line, 0.5 * (low.t + high.t))
            continue
        if not clear and high.value <= 0.0:
            break
        if high.t >= end.t:
            return -1.0
        second, fourth = bounds_from_trial(m, line, end.t - high.t)
        t = min(high.t + 2.0 * width, end.t)
        low, high = high, point_at(m, line, t) if t < end.t else end
    if low.value <= 0.0:
        return low.t
    return polished_root(m, line, low, high, end.t, second, fourth)
