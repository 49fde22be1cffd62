"""Forecasts: readings that a model predicts up to a horizon ahead, from states that an observer estimates.

A steady-state Kalman filter runs through a recording. At the start of each window its state is replayed freely to the end of the
window.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import Stated
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.observer import forecast_gains, modal_gains
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


@dataclass(frozen=True)
class Observer:
    """The filter that gives forecasts their states, designed once for each structure and kept while an arm's numbers vary.

    Attributes:
        dataset: the recordings.
        disturbances: for which it is designed.
        designed: physical gains (modes, states, signals), which arms of other values share, by what runs state, effects and
            size of the state.
        starts: initial states of the recordings.
    """

    dataset: Dataset
    disturbances: Disturbances
    designed: dict[tuple[Stated, tuple[str, ...], int, int], Floats] = field(default_factory=dict, repr=False, compare=False)
    starts: StartBank = field(default_factory=StartBank, repr=False, compare=False)

    def gains(self, arm: Arm, plant: Plant, stated: Stated) -> Floats:
        """Look up the kernel's gains for an arm's plant; design those of its structure for it where there are none yet."""
        key = (stated, tuple(arm.effects), plant.modes, plant.states)
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
    parts = [_forecast(arm, plants[run.stated], run, observer) for run in runs]
    return _finite(np.concatenate(parts))


def _finite(errors: Floats) -> Floats:
    return np.clip(np.nan_to_num(errors, nan=FAILED_ERROR), -FAILED_ERROR, FAILED_ERROR)


def _forecast(arm: Arm, plant: Plant, run: Run, observer: Observer) -> Floats:
    """Compute the errors over the noise (samples, signals) of one run."""
    length, readings = window_samples(observer.dataset), np.empty_like(run.measured)
    gains = observer.gains(arm, plant, run.stated)
    observer.place(plant, run)
    command = plant.delayed(run.command)
    for start in range(0, len(command), length):
        state = plant.state.copy()
        readings[start : start + length] = _play(plant, run, command, start, length)
        plant.state[:] = state
        _play(plant, run, command, start, length, gains)
    return run.errors(readings, observer.dataset.noise)


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
        plants: of the arm, by what runs state.
        starts: first sample of each window, by run.
        states: the kernel's state at each, by run.
    """

    dataset: Dataset
    observer: Observer
    plants: Mapping[Stated, Plant]
    starts: tuple[Integers, ...]
    states: tuple[Floats, ...]

    def errors(self, arm: Arm) -> Floats:
        """Forecast an arm in the windows: errors over the noise (rows, signals), run after run."""
        plants, length = self.dataset.plants(arm), window_samples(self.dataset)
        parts = []
        for run, starts, states in zip(self.dataset.fitted, self.starts, self.states, strict=True):
            plant = plants[run.stated]
            if not same_modes(plant, self.plants[run.stated]):
                errors = _forecast(arm, plant, run, self.observer)
                parts += [errors[start : start + length] for start in starts]
                continue
            command = plant.delayed(run.command)
            for start, state in zip(starts, states, strict=True):
                plant.state[:] = state
                rows = slice(start, start + length)
                parts.append(run.errors(_play(plant, run, command, start, length), self.dataset.noise, rows))
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
        plant, kept = plants[run.stated], []
        gains = observer.gains(arm, plant, run.stated)
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
