"""The step of a sensor's readings, and readings that repeat because the sensor is slower than the recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Fewest levels that show a grid: any two lie on one.
FEWEST_LEVELS = 3
#: Readings lie on a grid if this share of them is this close to it, in steps. Files round a step to their own decimals, so
#: that few readings lie on it exactly; of readings without a grid, 30 % lie so close by chance.
ON_GRID, OFF_STEP = 0.99, 0.15
#: Levels closer than this share of the largest are one: arithmetic rounds far below any converter's step.
ROUNDING = 1e-9
#: Readings are held where two changes in successive rows are rarer than this, over the number expected by chance, ...
HELD = 0.05
#: ... and where chance would give at least this many.
FEWEST_PAIRS = 10.0


def find_resolution(readings: Floats) -> float:
    """Find the step of the grid on which readings lie: the smallest that divides all their differences.

    Args:
        readings: (n,) finite.

    Returns:
        The step, in their unit; 0 where there is none, or fewer than three levels.

    Example:
        >>> round(find_resolution(np.round(np.linspace(0.0, 1.0, 50) / 0.07) * 0.07), 9)
        0.07
        >>> find_resolution(np.sqrt(np.arange(50.0)))
        0.0
    """
    levels, counts = np.unique(readings, return_counts=True)
    first = np.flatnonzero(np.diff(levels, prepend=-np.inf) > ROUNDING * np.abs(levels).max(initial=0.0))
    if len(first) < FEWEST_LEVELS:
        return 0.0
    levels, counts = levels[first], np.add.reduceat(counts, first)
    place = _places(np.diff(levels))
    step, start = np.polyfit(place, levels, 1)
    close = np.abs(levels - start - step * place) < OFF_STEP * step
    return float(step) if counts[close].sum() >= ON_GRID * counts.sum() else 0.0


def _places(gaps: Floats) -> Floats:
    """Number the levels on the grid of their smallest gap. The step is known the better, the wider the gaps that it divides."""
    step, reach = float(gaps.min()), 2.0
    while (near := gaps[gaps < reach * step]).sum() < gaps.sum():
        step = float(near.sum() / np.round(near / step).sum())
        reach *= 2.0
    return np.concatenate([[0.0], np.cumsum(np.round(gaps / step))])


def distinct_readings(time: Floats, readings: Floats) -> tuple[Floats, Floats]:
    """Leave out readings that repeat the last one where the sensor is slower than the rows.

    Readings of a slow sensor never change in two successive rows. Those of a coarse one do so by chance.

    Args:
        time: (n,) [s].
        readings: (n,) finite.

    Returns:
        Time and readings, (m,) each.
    """
    changes = np.concatenate([[True], np.diff(readings) != 0.0])
    by_chance = changes.mean() ** 2 * len(changes)
    in_succession = np.count_nonzero(changes[1:] & changes[:-1])
    if by_chance >= FEWEST_PAIRS and in_succession < HELD * by_chance:
        return time[changes], readings[changes]
    return time, readings
