"""Forecasts: readings that a model predicts up to a horizon ahead, from states that an observer estimates.

A steady-state Kalman filter runs through a recording. At the start of each window its state is replayed freely to the end of the
window. The errors of these forecasts have a variance that grows with the lead time, as far as unknown torques on the hub let it.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.observer import forecast_gains, modal_gains, process_of_moving, steady_covariance
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.start_bank import StartBank
from flexarm_env.identify.settings import FAILED_ERROR
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Disturbances:
    """Disturbances that a model does not explain.

    Attributes:
        torque: standard deviation of a torque on the hub, new in each sample [Nm].
        readings: (signals,) variance of each sensor's noise over the square of `Dataset.noise`.
    """

    torque: float
    readings: tuple[float, ...]

    @property
    def white(self) -> Floats:
        """Variance (signals,) of the sensors' white noise, which the recordings show: an error beyond it lasts."""
        return np.minimum(self.readings, 1.0)

    def unexplained_torque(self, interval: float, time: float) -> float:
        """Convert to the standard deviation [Nm] of a torque that lasts for some time [s], at a sampling interval [s]."""
        return float(self.torque * np.sqrt(min(interval / time, 1.0)))


@dataclass(frozen=True)
class Observer:
    """The filter that gives forecasts their states, designed once for each structure and kept while an arm's numbers vary.

    Attributes:
        dataset: the recordings.
        disturbances: for which it is designed.
        designed: physical gains (modes, states, signals), which arms of other values share, by payload [kg], effects and
            size of the state.
        starts: initial states of the recordings.
    """

    dataset: Dataset
    disturbances: Disturbances
    designed: dict[tuple[float, tuple[str, ...], int, int], Floats] = field(default_factory=dict, repr=False, compare=False)
    starts: StartBank = field(default_factory=StartBank, repr=False, compare=False)

    def gains(self, arm: Arm, plant: Plant, payload: float) -> Floats:
        """Look up the kernel's gains for an arm's plant; design those of its structure for it where there are none yet."""
        key = (payload, tuple(arm.effects), plant.modes, plant.states)
        if key not in self.designed:
            noise = self.dataset.noise * np.sqrt(self.disturbances.white)
            self.designed[key] = forecast_gains(plant, self.dataset, self.disturbances.torque, noise)
        return modal_gains(plant, self.designed[key])

    def place(self, plant: Plant, run: Run) -> None:
        """Put a plant into the initial state of a run."""
        place = [one.name for one in self.dataset.runs].index(run.name)
        self.dataset.stretch(run).place(plant, self.starts.start(plant, run, place, self.dataset))


def window_samples(dataset: Dataset) -> int:
    """Count the samples of a window of forecasts."""
    return max(round(dataset.settings.forecasts.horizon / dataset.interval), 1)


def forecast_errors(arm: Arm, dataset: Dataset, runs: Sequence[Run], observer: Observer) -> Floats:
    """Forecast runs in windows from filtered states.

    Args:
        arm: the model.
        dataset: to which the runs belong.
        runs: the recordings.
        observer: gains of the filter.

    Returns:
        Errors over the noise (rows, signals), run after run; 0 where nothing was measured.
    """
    plants = dataset.plants(arm)
    parts = [_forecast(arm, plants[run.payload], run, observer) for run in runs]
    return _finite(np.concatenate(parts))


def _finite(errors: Floats) -> Floats:
    return np.clip(np.nan_to_num(errors, nan=FAILED_ERROR), -FAILED_ERROR, FAILED_ERROR)


def _forecast(arm: Arm, plant: Plant, run: Run, observer: Observer) -> Floats:
    """Compute the errors over the noise (samples, signals) of one run."""
    length, readings = window_samples(observer.dataset), np.empty_like(run.measured)
    gains = observer.gains(arm, plant, run.payload)
    observer.place(plant, run)
    command = plant.delayed(run.command)
    for start in range(0, len(command), length):
        state = plant.state.copy()
        readings[start : start + length] = _play(plant, run, command, start, length)
        plant.state[:] = state
        _play(plant, run, command, start, length, gains)
    return _errors(run, readings, observer.dataset)


def _errors(run: Run, readings: Floats, dataset: Dataset, rows: slice = slice(None)) -> Floats:
    """Compute errors over the noise (samples, signals), infinite where a replay that failed leaves any range."""
    with np.errstate(over="ignore"):
        return run.errors(readings, dataset.noise, rows)


def _play(plant: Plant, run: Run, command: Floats, start: int, length: int, gains: Floats = NO_GAINS) -> Floats:
    """Play one window from the plant's state, up to the first sample of the next: readings (samples, signals).

    The first reading of the next window corrects no state yet, since it is to be forecast.
    """
    part = slice(start, start + length + 1)
    intervals = run.intervals[part] if len(run.intervals) else run.intervals
    measured = NOT_MEASURED
    if len(gains):
        measured = run.measured[part].copy()
        measured[length:] = np.nan
    return plant.play(command[part], intervals, gains, measured)[:length]


@dataclass(frozen=True)
class FilteredStates:
    """States of an arm's plants at the starts of windows, from which arms of the same modes can be forecast.

    An arm that differs in its laws alone is replayed from the states of this one: the filter corrects what the difference does
    to them.

    Attributes:
        dataset: the recordings.
        observer: the filter.
        plants: of the arm, by payload.
        starts: first sample of each window, by run.
        states: the kernel's state at each, by run.
    """

    dataset: Dataset
    observer: Observer
    plants: Mapping[float, Plant]
    starts: tuple[Integers, ...]
    states: tuple[Floats, ...]

    def errors(self, arm: Arm) -> Floats:
        """Forecast an arm in the windows: errors over the noise (rows, signals), run after run."""
        plants, length = self.dataset.plants(arm), window_samples(self.dataset)
        parts = []
        for run, starts, states in zip(self.dataset.fitted, self.starts, self.states, strict=True):
            plant = plants[run.payload]
            if not same_modes(plant, self.plants[run.payload]):
                errors = _forecast(arm, plant, run, self.observer)
                parts += [errors[start : start + length] for start in starts]
                continue
            command = plant.delayed(run.command)
            for start, state in zip(starts, states, strict=True):
                plant.state[:] = state
                rows = slice(start, start + length)
                parts.append(_errors(run, _play(plant, run, command, start, length), self.dataset, rows))
        return _finite(np.concatenate(parts))

    @property
    def rows(self) -> NDArray[np.bool_]:
        """Which rows of all errors are in the windows."""
        length, masks = window_samples(self.dataset), []
        for run, starts in zip(self.dataset.fitted, self.starts, strict=True):
            masks.append(np.isin(np.arange(len(run.command)) // length, starts // length))
        return np.concatenate(masks)


def filtered_states(arm: Arm, dataset: Dataset, observer: Observer, most: int) -> FilteredStates:
    """Filter the fitted part of all runs, and keep the states at the starts of windows, evenly spread, at most so many."""
    plants, length = dataset.plants(arm), window_samples(dataset)
    count = sum(-(-len(run.command) // length) for run in dataset.fitted)
    stride = max(-(-count // most), 1)
    all_starts, all_states = [], []
    for run in dataset.fitted:
        plant, kept = plants[run.payload], []
        gains = observer.gains(arm, plant, run.payload)
        observer.place(plant, run)
        command = plant.delayed(run.command)
        for start in range(0, len(command), length):
            if start // length % stride == 0:
                kept.append(plant.state.copy())
            _play(plant, run, command, start, length, gains)
        all_starts.append(np.arange(0, len(command), length)[::stride])
        all_states.append(np.array(kept))
    return FilteredStates(dataset, observer, plants, tuple(all_starts), tuple(all_states))


def same_modes(plant: Plant, other: Plant) -> bool:
    """Whether two plants have the same coordinates, so that the state of one is that of the other."""
    sizes = [(one.blocks, one.modes, one.bodies, one.states, one.delay_samples) for one in (plant, other)]
    return sizes[0] == sizes[1] and all(np.array_equal(plant.to_modal(mode), other.to_modal(mode)) for mode in range(plant.modes))


@dataclass(frozen=True)
class Leads:
    """Groups of lead times, in which forecasts have nearly the same variance.

    Attributes:
        group: (rows,) of each row of the errors.
        samples: (lead times,) in samples. The groups are those of the first payload, then of the next.
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
    payloads = list(dict.fromkeys(run.payload for run in dataset.runs))
    lead = [np.arange(len(run.command)) % length for run in runs]
    place = [payloads.index(run.payload) * len(ends) for run in runs]
    group = np.concatenate([first + np.searchsorted(ends, one + 1) for first, one in zip(place, lead, strict=True)])
    starts = np.concatenate([[1], ends[:-1] + 1])
    present = np.concatenate([~np.isnan(run.measured) for run in runs])
    most = len(payloads) * len(ends)
    return Leads(group, (starts + ends) // 2, _counts(group, present, most), present)


def _counts(group: Integers, present: NDArray[np.bool_], groups: int) -> Floats:
    """Count the readings (groups, signals) of each group."""
    return np.stack([np.bincount(group, column, minlength=groups) for column in present.T], axis=1).astype(np.float64)


@dataclass(frozen=True)
class Spread:
    """Variance of the forecasts of a linear, moving arm under disturbances.

    Attributes:
        plants: a compiled arm for each payload.
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


def spread_of(plants: Mapping[float, Plant], dataset: Dataset, leads: Leads) -> Spread:
    """Build the spread of an arm's forecasts from its plants by payload."""
    return Spread(tuple(plants[p] for p in dict.fromkeys(run.payload for run in dataset.runs)), dataset, leads.samples)


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
