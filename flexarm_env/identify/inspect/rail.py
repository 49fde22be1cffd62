"""Readings that stand at the end of the sensor's or the amplifier's range."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, percent
from flexarm_env.identify.inspect.series import Floats, Series
from flexarm_env.identify.settings import Inspecting
from flexarm_env.recordings.columns import UNITS
from flexarm_env.recordings.recording import Recording

#: Signals of the hub: where one of them rests, so does the other.
_HUB = ("arm_angle", "motor_speed")


def rail(recording: Recording, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find signals that stand at their largest or smallest reading as no noisy and no moving signal does."""
    found = []
    series = {signal: Series.of(recording, signal, numbers) for signal in recording.signals}
    for signal, one in series.items():
        ends = [end for end in (-1, 1) if _stands_at(end, signal, series, numbers)]
        if not ends:
            continue
        levels = [float((end * one.values).max()) * end for end in ends]
        at_level = np.isin(one.values, levels)
        value = max(levels, key=abs)
        both = len(levels) == 2 and math.isclose(*np.abs(levels), rel_tol=numbers.same_jump)
        ends_text = f"±{abs(value):.5g}" if both else " and ".join(f"{level:.5g}" for level in levels)
        unit = UNITS[signal]
        text = f"stands at its extreme of {ends_text} {unit} in {percent(float(at_level.mean()))} of the rows"
        low, high = _range(one, levels)
        hint = f'{signal} = {{ range = ["{_within(low)} {unit}", "{_within(high)} {unit}"] }}'
        found.append(fault(recording, signal, "rail", abs(value) if both else value, text, hint, one.rows[at_level]))
    return found


def _range(series: Series, levels: list[float]) -> tuple[float, float]:
    """Choose a range that ends at the levels; an end that the readings do not reach lies as far out as they extend."""
    low, high = float(series.values.min()), float(series.values.max())
    extent = high - low
    return (low if low in levels else low - extent), (high if high in levels else high + extent)


def _within(end: float) -> str:
    """Format the end of a range so that the readings at it do not lie inside."""
    text = f"{end:.6g}"
    return text if abs(float(text)) <= abs(end) else repr(end)


def _stands_at(end: int, signal: str, series: dict[str, Series], numbers: Inspecting) -> bool:
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
    repeated = _evidence(follow, count, _usual_repeats(one, values < values.max(), numbers)) > numbers.evidence
    if one.flicker > numbers.flickers:
        return repeated or _piles_up(values, one.step, count, numbers)
    episodes = starts[at_end & (lengths >= numbers.least_run)]
    return repeated and _is_cut(values, episodes, one.step, numbers) and not _rests(end, signal, series, numbers)


def _piles_up(values: Floats, step: float, count: int, numbers: Inspecting) -> bool:
    """Whether a flickering signal has more readings at its end than a step before it, where noise has fewer."""
    before = int(np.sum(values > values.max() - (1 + 1 / 2) * step)) - count
    return (count - before) > numbers.piled_up * math.sqrt(count + before)


def _usual_repeats(series: Series, elsewhere: np.ndarray, numbers: Inspecting) -> float:
    """Compute the largest share of repeated readings in a stretch of the signal, away from its extreme."""
    repeated = ((series.changes == 0.0) & elsewhere[1:])[: len(series) // numbers.stretches * numbers.stretches]
    away = elsewhere[1 : 1 + len(repeated)]
    pieces = len(repeated) // numbers.stretches * numbers.stretches
    sums = [part[:pieces].reshape(numbers.stretches, -1).sum(axis=1) for part in (repeated, away)]
    enough = sums[1] >= numbers.fewest_at_rail
    shares = sums[0][enough] / sums[1][enough]
    return float(np.clip(shares.max() if shares.size else 1.0, numbers.least_repeats, 1.0))


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
