"""Readings that leave the signal and return to it: single ones (spikes), and equal ones in place of those that were lost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.inspect.series import Floats, Integers, Series
from flexarm_env.identify.settings import Inspecting


@dataclass(frozen=True)
class Stretches:
    """Readings that leave a signal and return to it.

    Attributes:
        first: (m,) index of the first reading of each stretch.
        length: (m,) readings.
        height: (m,) of the first reading over the signal around it.
    """

    first: Integers
    length: Integers
    height: Floats

    def where(self, mask: NDArray[np.bool_]) -> Stretches:
        """Choose some of them."""
        return Stretches(self.first[mask], self.length[mask], self.height[mask])

    def readings(self) -> Integers:
        """List the index of every reading in them."""
        parts = [np.arange(a, a + n) for a, n in zip(self.first, self.length, strict=True)]
        return np.concatenate(parts) if parts else np.zeros(0, dtype=np.int64)


def usual_change(series: Series, numbers: Inspecting) -> float:
    """Estimate the size of change that a signal seldom exceeds."""
    return float(np.quantile(np.abs(series.changes), numbers.usual)) if len(series) > 1 else 0.0


def excursions(series: Series, numbers: Inspecting) -> Stretches:
    """Find equal readings in a row, one or several, that stand off the readings on both sides, and on the same side."""
    starts, lengths = series.runs()
    if len(starts) < 3:
        return Stretches(*(np.zeros(0, dtype=np.int64),) * 2, np.zeros(0))
    values, first, length = series.values[starts], starts[1:-1], lengths[1:-1]
    into, out = values[1:-1] - values[:-2], values[1:-1] - values[2:]
    height = 0.5 * (into + out)
    # In motion the readings on both sides differ, too.
    stands_off = np.where(into * out > 0.0, np.minimum(np.abs(into), np.abs(out)), 0.0) > numbers.wild_side * np.abs(height)
    chance = max(numbers.wild_noise * series.noise, numbers.wild_steps * series.step)
    suspect = stands_off & (np.abs(height) > chance) & (length <= numbers.longest_loss * len(series))
    # A signal that is sampled too slowly for its motion changes as much elsewhere.
    others = np.delete(np.abs(series.changes), np.r_[first[suspect] - 1, first[suspect] + length[suspect] - 1])
    largest = float(others.max(initial=0.0))
    least = max(numbers.wild * usual_change(series, numbers), numbers.wild_largest * largest)
    wild = suspect & (np.abs(height) > least)
    return Stretches(first[wild], length[wild], height[wild])


def split(series: Series, numbers: Inspecting) -> tuple[Stretches, Stretches]:
    """Split excursions into spikes and losses: a loss repeats its reading, or is exactly 0, as no spike is by chance."""
    found = excursions(series, numbers)
    values = series.values[found.first]
    again = np.array([np.sum(values == value) for value in values]) > 1
    lost = (found.length > 1) | again | (values == 0.0)
    return found.where(~lost), found.where(lost)
