"""Evidence that a signal stands at the end of a range, beyond noise, rest and chance."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.identify.inspect.series import Floats, Series
from flexarm_env.identify.settings import Inspecting

#: Signals of the hub: where one of them rests, so does the other.
_HUB = ("arm_angle", "motor_speed")


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
    repeated = _evidence(follow, count, one.most_repeats(values < values.max(), numbers)) > numbers.evidence
    if one.flicker > numbers.flickers:
        return repeated or _piles_up(values, one.step, count, numbers)
    episodes = starts[at_end & (lengths >= numbers.least_run)]
    return repeated and _is_cut(values, episodes, one.step, numbers) and not _rests(end, signal, series, numbers)


def _piles_up(values: Floats, step: float, count: int, numbers: Inspecting) -> bool:
    """Whether a flickering signal has more readings at its end than a step before it, where noise has fewer."""
    before = int(np.sum(values > values.max() - (1 + 1 / 2) * step)) - count
    return (count - before) > numbers.piled_up * math.sqrt(count + before)


def _evidence(follow: int, count: int, usual: float) -> float:
    """Compute the logarithm of the odds that so many readings repeat (Chernoff's bound of a binomial)."""
    share = follow / count
    if share <= usual:
        return 0.0
    rest = (1 - share) * math.log((1 - share) / (1 - usual)) if share < 1 else 0.0
    return count * (share * math.log(share / usual) + rest)


def _is_cut(values: Floats, episodes: np.ndarray, step: float, numbers: Inspecting) -> bool:
    """Whether the signal runs into its extreme at a slope, where a motion that ends there comes in slowly."""
    before = np.maximum(episodes - numbers.least_run, 0)
    slopes = (values[episodes] - values[before]) / np.maximum(episodes - before, 1)
    return bool(slopes.size) and float(np.median(slopes)) > numbers.cut_slope * step


def _rests(end: int, signal: str, series: dict[str, Series], numbers: Inspecting) -> bool:
    """Whether the hub rests while a signal stands at its extreme, so that the extreme is a reading at rest."""
    one = series[signal]
    standing = one.rows[end * one.values == (end * one.values).max()]
    level = abs(float(one.values[np.searchsorted(one.rows, standing[0])]))
    if level < numbers.near_zero * np.ptp(one.values):
        return True
    partners = [s for s in series if s != signal and (signal not in _HUB or s in _HUB)]
    quiet = []
    for other in (series[s] for s in partners):
        known = np.isin(other.rows, standing)
        limit = numbers.quiet * max(other.noise, other.step)
        quiet.append(bool(known.any()) and float(np.std(other.values[known])) < limit)
    return bool(quiet) and all(quiet)
