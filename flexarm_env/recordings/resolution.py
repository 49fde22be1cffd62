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


def distinct_readings(readings: Floats) -> NDArray[np.bool_]:
    """Mark the readings that count: all, or one of each beat where the sensor is slower than the rows.

    Readings of a slow sensor never change in two successive rows. Those of a coarse one do so by chance. Where a slow one keeps
    no beat, each change counts.

    Args:
        readings: (n,) finite.

    Returns:
        (n,) True for those that count.
    """
    changes = np.flatnonzero(np.diff(readings)) + 1
    share = len(changes) / max(len(readings), 1)
    by_chance, gaps = share * len(changes), np.diff(changes)
    if by_chance < FEWEST_PAIRS or np.count_nonzero(gaps == 1) >= HELD * by_chance:
        return np.ones(len(readings), dtype=np.bool_)
    beats = np.flatnonzero(np.bincount(gaps) >= HELD * len(gaps))
    if beats.size:
        return ~repeated_readings(readings, int(beats[0]))
    return np.diff(readings, prepend=np.inf) != 0.0


def repeated_readings(readings: Floats, beat: int) -> NDArray[np.bool_]:
    """Mark the rows that only repeat a reading, beat by beat from each change; before the first change, back from it.

    Args:
        readings: (n,).
        beat: rows for which each reading is held. One that is due less than half a beat before a change is that change.

    Returns:
        (n,) True where nothing was measured.
    """
    changes = np.flatnonzero(readings[1:] != readings[:-1]) + 1
    rows = np.arange(len(readings))
    before = np.searchsorted(changes, rows, side="right") - 1
    since = rows - (changes[np.maximum(before, 0)] if changes.size else 0)
    until = np.append(changes, len(readings) + beat)[before + 1] - rows
    return np.asarray((since % beat != 0) | (since > 0) & (2 * until <= beat))
