"""Evidence that a signal stands at the end of a range, beyond noise, rest and chance."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from flexarm_env.identify.inspect.series import Floats, Integers, Series, partners
from flexarm_env.identify.settings import Inspecting


def stands_at(end: int, signal: str, series: dict[str, Series], numbers: Inspecting) -> bool:
    """Whether a signal stands at its largest (end 1) or smallest (-1) reading by more than chance and rest explain."""
    one = series[signal]
    if len(one) < numbers.fewest_at_rail or one.step == 0.0:
        return False
    values = end * one.values
    starts, lengths = one.runs()
    at_end = values[starts] == values.max()
    count = int(lengths[at_end].sum())
    if count < numbers.fewest_at_rail:
        return False
    follow = count - int(at_end.sum())
    usual = one.most_repeats(values < values.max(), numbers)
    standing = one.rows[values == values.max()]
    others = partners(signal, series)
    if one.flicker > numbers.flickers:
        still = all(other.stands_still(standing, numbers) for other in others)
        near_zero = abs(values.max()) < numbers.near_zero * np.ptp(values)
        if still and (bool(others) or near_zero):
            return False
        wide = one.noise > numbers.wide_noise * one.step
        repeated = _evidence(follow, count, max(usual, one.repeats_at_rest(numbers))) > numbers.evidence
        return repeated or (_piles_up(values, one, count, numbers) and (wide or _is_cut(values, one, numbers)))
    repeated = _evidence(follow, count, usual) > numbers.evidence
    return repeated and _is_cut(values, one, numbers) and not _rests(one, values.max(), standing, others, numbers)


def _piles_up(values: Floats, series: Series, count: int, numbers: Inspecting) -> bool:
    """Whether a flickering signal has more readings at its end than a step before it, where noise has fewer.

    Noise wider than a step thins out towards its end, so that even half as many are too many.
    """
    before = int(np.sum(values > values.max() - (1 + 1 / 2) * series.step)) - count
    if series.noise > numbers.wide_noise * series.step and count >= numbers.many_at_rail and 2 * count > before:
        return True
    return (count - before) > numbers.piled_up * math.sqrt(count + before)


def _evidence(follow: int, count: int, usual: float) -> float:
    """Compute the logarithm of the odds that so many readings, fewer than all, repeat (Chernoff's bound of a binomial)."""
    share = follow / count
    if share <= usual:
        return 0.0
    return count * (share * math.log(share / usual) + (1 - share) * math.log((1 - share) / (1 - usual)))


def _is_cut(values: Floats, series: Series, numbers: Inspecting) -> bool:
    """Whether the signal would go on beyond its extreme, at a slope, where a motion that ends there slows down to it.

    A last digit that flickers at rest leaves the extreme by one step, and does not arrive there anew.
    """
    starts, lengths = series.runs()
    stands = starts[(values[starts] == values.max()) & (lengths >= numbers.least_run)]
    away = values < values.max() - numbers.more_than_a_step * series.step
    stays = np.cumsum(away)
    arrivals = stands[np.r_[True, np.diff(stays[stands]) > 0]] if stands.size else stands
    before = np.maximum(arrivals - numbers.least_run, 0)
    earlier = np.maximum(before - numbers.least_run, 0)
    slopes, earlier_slopes = (
        (values[last] - values[first]) / np.maximum(last - first, 1) for first, last in ((before, arrivals), (earlier, before))
    )
    ahead = np.minimum(slopes, 2.0 * slopes - earlier_slopes)
    return bool(ahead.size) and float(np.median(ahead)) > numbers.cut_slope * series.step


def _rests(series: Series, level: float, standing: Integers, others: Sequence[Series], numbers: Inspecting) -> bool:
    """Whether the hub rests while a signal stands at its extreme, so that the extreme is a reading at rest.

    Args:
        series: of the signal.
        level: its extreme.
        standing: samples at which it stands there.
        others: that rest where the signal does.
        numbers: of the inspection.
    """
    if abs(level) < numbers.near_zero * np.ptp(series.values):
        return True
    quiet = []
    for other in others:
        known = np.isin(other.rows, standing)
        limit = numbers.quiet * max(other.noise, other.step)
        quiet.append(bool(known.any()) and float(np.std(other.values[known])) < limit)
    return bool(quiet) and all(quiet)
