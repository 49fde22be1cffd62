"""The spread of forecasts: their variance grows with the lead time, as far as unknown torques on the hub let it."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.experiments.stated import Stated
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.forecast import Disturbances, window_samples
from flexarm_env.identify.replay.observer import process_of_moving, steady_covariance
from flexarm_env.identify.replay.run import Run
from flexarm_env.plant.plant import Plant

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Leads:
    """Groups of lead times, in which forecasts have nearly the same variance.

    Attributes:
        group: (rows,) of each row of the errors.
        samples: (lead times,) in samples. The groups are those of the first runs that state the same, then of the next.
        counts: (groups, signals) readings.
        present: (rows, signals) whether there is a reading.
    """

    group: Integers
    samples: Integers
    counts: Floats
    present: NDArray[np.bool_]

    def of(self, rows: NDArray[np.bool_]) -> Leads:
        """Select rows."""
        group, present = self.group[rows], self.present[rows]
        return Leads(group, self.samples, _counts(group, present, len(self.counts)), present)

    def mean_squares(self, errors: Floats) -> Floats:
        """Compute the mean square (groups, signals) of errors (rows, signals)."""
        sums = [np.bincount(self.group, column, minlength=len(self.counts)) for column in (errors**2).T]
        return np.stack(sums, axis=1) / np.maximum(self.counts, 1.0)


def lead_times(dataset: Dataset, runs: Sequence[Run]) -> Leads:
    """Group the samples of runs by their lead time, in groups that widen with it."""
    length = window_samples(dataset)
    ends = np.unique(np.round(np.geomspace(1, length, dataset.settings.forecasts.groups)).astype(np.int64))
    stated = list(dict.fromkeys(run.stated for run in dataset.runs))
    lead = [np.arange(len(run.command)) % length for run in runs]
    place = [stated.index(run.stated) * len(ends) for run in runs]
    group = np.concatenate([first + np.searchsorted(ends, one + 1) for first, one in zip(place, lead, strict=True)])
    starts = np.concatenate([[1], ends[:-1] + 1])
    present = np.concatenate([~np.isnan(run.measured) for run in runs])
    most = len(stated) * len(ends)
    return Leads(group, (starts + ends) // 2, _counts(group, present, most), present)


def _counts(group: Integers, present: NDArray[np.bool_], groups: int) -> Floats:
    """Count the readings (groups, signals) of each group."""
    return np.stack([np.bincount(group, column, minlength=groups) for column in present.T], axis=1).astype(np.float64)


@dataclass(frozen=True)
class Spread:
    """Variance of the forecasts of a linear, moving arm under disturbances.

    Attributes:
        plants: a compiled arm for each that the runs state.
        dataset: the recordings.
        samples: (lead times,) in samples.
    """

    plants: tuple[Plant, ...]
    dataset: Dataset
    samples: Integers

    @functools.cached_property
    def _by_lead(self) -> list[tuple[Floats, Floats, Floats]]:
        return [_growth(plant, self.dataset, self.samples) for plant in self.plants]

    def growth(self, disturbances: Disturbances) -> Floats:
        """Compute the variance (groups, signals) of forecasts without the errors of readings, over that of the noise."""
        noise = self.dataset.noise
        variances = []
        for plant, (rows, by_torque, by_rest) in zip(self.plants, self._by_lead, strict=True):
            covariance = steady_covariance(plant, self.dataset, disturbances.torque, noise * np.sqrt(disturbances.white))
            state = np.einsum("gij,jk,gik->gi", rows, covariance, rows)
            variances.append((state + disturbances.torque**2 * by_torque + by_rest) / noise**2)
        return np.concatenate(variances)


def spread_of(plants: Mapping[Stated, Plant], dataset: Dataset, leads: Leads) -> Spread:
    """Build the spread of an arm's forecasts from its plants by what runs state."""
    return Spread(tuple(plants[p] for p in dict.fromkeys(run.stated for run in dataset.runs)), dataset, leads.samples)


def _growth(plant: Plant, dataset: Dataset, samples: Integers) -> tuple[Floats, Floats, Floats]:
    """Compute how the state's covariance and disturbances reach the readings at lead times.

    Returns:
        Rows (lead times, signals, states) from the state; variances (lead times, signals) by 1 Nm on the hub, and by the rest.
    """
    transition, unit, rest = process_of_moving(plant, dataset)
    ahead = np.asarray(plant.model.output)
    rows = []
    for _ in range(int(samples[-1])):
        rows.append(ahead)
        ahead = ahead @ transition
    stacked = np.array(rows)
    by_torque, by_rest = (
        np.concatenate([np.zeros((1, len(ahead))), np.cumsum(np.einsum("gij,jk,gik->gi", stacked, q, stacked), axis=0)])
        for q in (unit, rest)
    )
    return stacked[samples - 1], by_torque[samples - 1], by_rest[samples - 1]
