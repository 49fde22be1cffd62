"""How the error of an arm is measured: in windows and in a free run, or by innovations where torque noise is stated."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import Stated
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.observer import innovation_sigma, innovation_sigmas, observer_gains
from flexarm_env.identify.replay.readings import bounded
from flexarm_env.identify.replay.replay import WindowStates, replay, states_before, whole_replay, window_observers, window_replay
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.settings import LEAST_EXCESS
from flexarm_env.identify.threads import in_threads
from flexarm_env.plant.plant import Plant

Floats = NDArray[np.float64]


def excess(error: float) -> float:
    """Compute the excess of an error over the noise, as a variance."""
    return max(error**2 - 1.0, LEAST_EXCESS)


@dataclass(frozen=True)
class SignalError:
    """Error of one signal in windows.

    Attributes:
        over_noise: rms over noise: 1 is perfect.
        rms: the same in the signal's SI unit.
    """

    over_noise: float
    rms: float

    @property
    def excess(self) -> float:
        """Excess over the noise, as a variance."""
        return excess(self.over_noise)


@dataclass(frozen=True)
class Score:
    """Errors of an arm on one part of the data, rms over noise: 1 is perfect.

    Attributes:
        windows: in windows of 1 s from estimated states; where torque noise is stated, the rms of the innovations over their
            standard deviation under both noises, since such a disturbance drives any free replay away within a window.
        free_run: each recording replayed once from its start under the recorded command.
        signals: the errors in windows by signal, of those with a reading. Their squares, weighted by the number of readings,
            average to that of `windows`.
    """

    windows: float
    free_run: float
    signals: Mapping[str, SignalError] = field(default_factory=dict, hash=False)

    @property
    def excess(self) -> float:
        """Excess of the error in windows, as a variance."""
        return excess(self.windows)

    @property
    def free_run_excess(self) -> float:
        """Excess of the error of the free run, as a variance."""
        return excess(self.free_run)

    @property
    def mean_excess(self) -> float:
        """Geometric mean of both."""
        return math.sqrt(self.excess * self.free_run_excess)

    def is_better_than(self, other: Score) -> bool:
        """Whether the product of both errors is smaller."""
        return self.windows * self.free_run < other.windows * other.free_run


class ErrorMeasure(Protocol):
    """How errors are measured."""

    @property
    def judges_free_run(self) -> bool:
        """Whether a replay of whole recordings says anything about the model."""

    def score(self, arm: Arm, dataset: Dataset, held_out: bool) -> Score:
        """Measure the errors of an arm on the held-out or the fitted part."""

    def states_before(self, arm: Arm, dataset: Dataset) -> list[WindowStates]:
        """Estimate the states of an arm before the held-out part of each run, from which arms that are nearly the same begin."""

    def brief_readings(self, arm: Arm, dataset: Dataset, begun: Sequence[WindowStates] = ()) -> list[Floats]:
        """Compute the held-out readings (rows, signals) of each run over their deviation, to compare arms nearly the same.

        Beams are left their slow vibrations alone.

        Args:
            arm: the model.
            dataset: the recordings.
            begun: states of an arm that is nearly the same.
        """


@dataclass(frozen=True)
class WindowErrors:
    """Errors in windows of 1 s from estimated states, and of one free run."""

    judges_free_run: bool = True

    def score(self, arm: Arm, dataset: Dataset, held_out: bool) -> Score:
        """Measure the errors of an arm on the held-out or the fitted part."""
        plants = dataset.plants(arm)
        observers = {stated: window_observers(arm, plant, dataset) for stated, plant in plants.items()}

        def errors_of(run: Run) -> tuple[Floats, Floats]:
            rows = ~run.train if held_out else run.train
            plant, first = plants[run.stated].with_own_state(), int(np.argmax(rows))
            start = dataset.stretch(run).fit(plant)
            windows = window_replay(plant, run, dataset, observers[run.stated], first, start)
            free = replay(plant, run, dataset, start=start)
            return run.errors(windows, dataset.noise)[rows], run.errors(free, dataset.noise)[rows]

        both = in_threads(errors_of, [(run,) for run in dataset.runs_to_replay(held_out)])
        squares = np.sum([[_squares(windows), _squares(free)] for windows, free in both], axis=0)
        windows, free = np.sqrt(squares / dataset.readings(held_out))
        parts = [(errors, dataset.noise) for errors, _ in both]
        return Score(float(windows), float(free), _by_signal(parts, dataset, held_out))

    def states_before(self, arm: Arm, dataset: Dataset) -> list[WindowStates]:
        """Estimate the states of an arm a window before the held-out part of each run."""
        plants = dataset.plants(arm, reduced=True)
        observers = self._brief_observers(arm, plants, dataset)
        firsts = [int(np.argmax(~run.train)) for run in dataset.runs]
        pairs = zip(dataset.runs, firsts, strict=True)
        return [states_before(plants[run.stated], run, dataset, observers[run.stated], first) for run, first in pairs]

    def brief_readings(self, arm: Arm, dataset: Dataset, begun: Sequence[WindowStates] = ()) -> list[Floats]:
        """Compute the held-out readings (rows, signals) of each run in windows, over the noise."""
        windows = self._brief_windows(arm, dataset, begun)
        return [one[~run.train] / dataset.noise for run, one in zip(dataset.runs, windows, strict=True)]

    def _brief_windows(self, arm: Arm, dataset: Dataset, begun: Sequence[WindowStates] = ()) -> Iterator[Floats]:
        """Replay the held-out part of each run in windows; rows before it are left empty."""
        plants = dataset.plants(arm, reduced=True)
        observers = self._brief_observers(arm, plants, dataset)
        starts: Sequence[WindowStates | None] = begun or [None] * len(dataset.runs)
        for run, start in zip(dataset.runs, starts, strict=True):
            first = int(np.argmax(~run.train))
            yield window_replay(plants[run.stated], run, dataset, observers[run.stated], first, start)

    @staticmethod
    def _brief_observers(arm: Arm, plants: Mapping[Stated, Plant], dataset: Dataset) -> dict[Stated, list[Floats]]:
        levels = dataset.settings.process_noise.windows_brief
        return {stated: window_observers(arm, plant, dataset, levels)[1:] for stated, plant in plants.items()}


@dataclass(frozen=True)
class InnovationErrors:
    """Innovations of the observer that the stated torque noise gives."""

    judges_free_run: bool = False

    def score(self, arm: Arm, dataset: Dataset, held_out: bool) -> Score:
        """Measure the errors of an arm on the held-out or the fitted part."""
        plants, parts, free = dataset.plants(arm), [], 0.0
        for run, (corrected, sigma) in zip(dataset.runs, self._innovations(arm, dataset), strict=True):
            rows = ~run.train if held_out else run.train
            parts.append((corrected[rows], sigma[rows]))
            free += _squares(run.errors(replay(plants[run.stated], run, dataset), dataset.noise)[rows])
        count = dataset.readings(held_out)
        total = sum(_squares(errors) for errors, _ in parts)
        return Score(float(np.sqrt(total / count)), float(np.sqrt(free / count)), _by_signal(parts, dataset, held_out))

    def _innovations(self, arm: Arm, dataset: Dataset) -> Iterator[tuple[Floats, Floats]]:
        """Compute the innovations (samples, signals) of each run over their deviation, and that deviation."""
        plants, own = dataset.plants(arm), arm.constants["drive"]["torque_noise"]
        gains = {stated: observer_gains(arm, plant, dataset, own) for stated, plant in plants.items()}
        stationary = {stated: innovation_sigma(plant, dataset, own) for stated, plant in plants.items()}
        for run in dataset.runs:
            plant, gain = plants[run.stated], gains[run.stated]
            sigma = np.broadcast_to(stationary[run.stated], run.measured.shape)
            if run.readings() < run.measured.size:
                sigma = innovation_sigmas(plant, run, dataset, own, gain)
            yield run.errors(replay(plant, run, dataset, gain), sigma), sigma

    def states_before(self, arm: Arm, dataset: Dataset) -> list[WindowStates]:
        """Estimate no states: innovations need the whole recordings."""
        return []

    def brief_readings(self, arm: Arm, dataset: Dataset, begun: Sequence[WindowStates] = ()) -> list[Floats]:
        """Compute the predictions (rows, signals) of each run's held-out part, over the deviation of the innovations."""
        plants, own = dataset.plants(arm, reduced=True), arm.constants["drive"]["torque_noise"]
        gains = {stated: observer_gains(arm, plant, dataset, own) for stated, plant in plants.items()}
        sigmas = {stated: innovation_sigma(plant, dataset, own) for stated, plant in plants.items()}
        predicted = [(run, replay(plants[run.stated], run, dataset, gains[run.stated])) for run in dataset.runs]
        return [one[~run.train] / sigmas[run.stated] for run, one in predicted]


def error_measure(arm: Arm) -> ErrorMeasure:
    """Choose how the errors of an arm are measured: by innovations where its file states a torque noise."""
    return InnovationErrors() if arm.constants["drive"]["torque_noise"] > 0.0 else WindowErrors()


def score(arm: Arm, dataset: Dataset, held_out: bool = True) -> Score:
    """Measure the errors of an arm on the held-out part of the recordings, or on the fitted part."""
    return error_measure(arm).score(arm, dataset, held_out)


def closed_loop_errors(arms: Mapping[str, Arm], dataset: Dataset) -> dict[str, float]:
    """Measure the held-out errors of arms in closed loop, by name; none where no recording was made in a known loop."""
    return {name: _closed_loop_error(arm, dataset) for name, arm in arms.items()} if dataset.has_loop else {}


def window_errors(arm: Arm, plants: Mapping[Stated, Plant], dataset: Dataset) -> list[Floats]:
    """Compute the errors over noise (samples, signals) of each whole run in windows; 0 where nothing was measured."""
    observers = {stated: window_observers(arm, plant, dataset) for stated, plant in plants.items()}

    def errors_of(run: Run) -> Floats:
        replayed = window_replay(plants[run.stated].with_own_state(), run, dataset, observers[run.stated])
        return bounded(run.errors(replayed, dataset.noise))

    return in_threads(errors_of, [(run,) for run in dataset.runs])


def _closed_loop_error(arm: Arm, dataset: Dataset) -> float:
    """Measure the held-out error of whole recordings in closed loop; recordings without a loop count in a free run."""
    plants = dataset.plants(arm)
    errors = [run.errors(whole_replay(plants[run.stated], run, dataset), dataset.noise)[~run.train] for run in dataset.runs]
    return float(np.sqrt(sum(map(_squares, errors)) / dataset.readings(held_out=True)))


def _by_signal(parts: Sequence[tuple[Floats, Floats]], dataset: Dataset, held_out: bool) -> dict[str, SignalError]:
    """Compute the rms of errors (rows, signals) over their deviation, (signals,) or (rows, signals), of all runs, by signal."""
    counts = dataset.readings_by_signal(held_out)
    some = np.maximum(counts, 1)
    over_noise = np.sqrt(np.sum([np.sum(bounded(errors) ** 2, axis=0) for errors, _ in parts], axis=0) / some)
    rms = np.sqrt(np.sum([np.sum((bounded(errors) * sigma) ** 2, axis=0) for errors, sigma in parts], axis=0) / some)
    rows = zip(dataset.signals, counts, over_noise, rms, strict=True)
    return {signal: SignalError(float(error), float(size)) for signal, count, error, size in rows if count}


def _squares(errors: Floats) -> float:
    return float(np.sum(bounded(errors) ** 2))
