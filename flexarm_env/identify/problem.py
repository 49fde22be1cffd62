"""Residuals of an arm against data as a function of its fitted coordinates, at one level of process noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.coordinates import Coordinate, place_values
from flexarm_env.identify.data import Data
from flexarm_env.identify.observer import innovation_sigma
from flexarm_env.identify.predict import observer_gains, replay, window_observers, window_replay
from flexarm_env.identify.run import Run
from flexarm_env.plant.plant import Plant

Floats = NDArray[np.float64]

#: A residual larger than this many of its standard deviations counts as this: one bad moment must not rule a fit.
LARGEST_RESIDUAL = 1e4
#: Time [s] from which on errors count where torque noise is stated: until then they show how far the start was off, which
#: that noise keeps from being known (the published recipe for EMPS leaves out its first 49 ms as well).
SETTLING = 0.05
#: Time [s] over which the errors of a model that is far off hang together.
MEMORY = 0.02
#: Torque noises of the replays from which brief scores start, over the rms of the drive's torque.
BRIEF_LEVELS = (2e-3, 2e-2)


@dataclass
class Problem:
    """Replays of an arm, whitened.

    Attributes:
        arm: whose values the coordinates replace.
        data: the recordings.
        coordinates: what is fitted.
        torque_noise: process noise [Nm]; 0 for free replays.
        sigma: (runs, signals) by which errors are divided.
        held_out: whether the residual is that of the part held out, not of the part fitted.
    """

    arm: Arm
    data: Data
    coordinates: Sequence[Coordinate]
    torque_noise: float
    sigma: Floats
    held_out: bool = False

    def __post_init__(self) -> None:
        self._gains: dict[tuple[float, tuple[str, ...], int, int], Floats] = {}
        self.prior = np.array([c.prior for c in self.coordinates])

    def weigh(self, arm: Arm, held: bool = True) -> None:
        """Divide errors by what they are for an arm; and hold constants the closer to their priors the less is explained.

        Errors that a model cannot explain hang together: those of one moment count once, however many samples there are.
        Without that a search strays to constants that no machine has.

        Args:
            arm: whose errors are the measure.
            held: whether priors are narrowed so.
        """
        self.sigma = rms_by_run(self.errors_of(arm), self.data)
        unexplained = (1.0 - 1.0 / np.mean((self.sigma / self.data.noise) ** 2)) if held else 0.0
        together = 1.0 + unexplained * max(MEMORY / self.data.interval - 1.0, 0.0)
        self.prior = np.array([c.prior / (np.sqrt(together) if c.is_constant else 1.0) for c in self.coordinates])

    def residual(self, x: Floats) -> Floats:
        """Return (rows,): errors over sigma, run by run, sample by sample, signal by signal."""
        return self.residual_of(place_values(self.arm, self.coordinates, x))

    def residual_of(self, arm: Arm) -> Floats:
        """Return the residual of another arm under the same weights."""
        runs = self.data.runs if self.held_out else self.data.fitted
        parts = []
        for run, error, sigma in zip(runs, self._errors(arm, runs), self.sigma, strict=True):
            parts.append(((error[~run.train] if self.held_out else error) / sigma).ravel())
        return np.clip(np.nan_to_num(np.concatenate(parts), nan=LARGEST_RESIDUAL), -LARGEST_RESIDUAL, LARGEST_RESIDUAL)

    def errors_of(self, arm: Arm) -> list[Floats]:
        """Return measured less replayed (samples, signals) of the fitted part of each run, SI units."""
        return self._errors(arm, self.data.fitted)

    def _errors(self, arm: Arm, runs: Sequence[Run]) -> list[Floats]:
        plants = self.data.plants(arm)
        errors = []
        for run in runs:
            plant = plants[run.payload]
            gains = self._gains_for(arm, plant, run.payload) if self.torque_noise > 0.0 else None
            errors.append(run.measured - replay(plant, run, self.data.noise, gains))
            if arm.constants["drive"]["torque_noise"] > 0.0:
                errors[-1][: round(SETTLING / self.data.interval)] = 0.0
        return errors

    def _gains_for(self, arm: Arm, plant: Plant, payload: float) -> Floats:
        # the same gains while an arm's numbers are fitted, others for another arm
        key = (payload, tuple(arm.effects), plant.modes, plant.states)
        if key not in self._gains:
            self._gains[key] = observer_gains(arm, plant, self.data, self.torque_noise)
        return self._gains[key]


def rms_by_run(errors: Sequence[Floats], data: Data) -> Floats:
    """Return (runs, signals): the rms error of the part that is fitted, at least the noise."""
    found = np.array([np.sqrt(np.mean(e**2, axis=0)) for e in errors])
    return np.maximum(np.nan_to_num(found, nan=np.inf, posinf=1e6), data.noise)


@dataclass(frozen=True)
class Score:
    """Errors of an arm on one part of the data, rms over noise: in windows of 1 s, and replayed freely.

    For an arm whose file states a torque noise, `windows` is the rms of the innovations over what both noises make of them:
    such a disturbance drives a free replay away within a window, whatever the model.
    """

    windows: float
    free_run: float


def score(arm: Arm, data: Data, held_out: bool = True) -> Score:
    """Return the errors of an arm on what was held out, or on what was fitted."""
    plants = data.plants(arm)
    if arm.constants["drive"]["torque_noise"] > 0.0:
        return _score_innovations(arm, plants, data, held_out)
    observers = {payload: window_observers(arm, plant, data) for payload, plant in plants.items()}
    totals = np.zeros(2)
    count = 0
    for run in data.runs if held_out else data.fitted:
        rows = ~run.train if held_out else run.train
        plant, first = plants[run.payload], int(np.argmax(rows))
        windows = window_replay(plant, run, observers[run.payload], data.noise, data.interval, first)
        totals += [_squares(run, replayed, rows, data) for replayed in (windows, replay(plant, run, data.noise))]
        count += int(rows.sum()) * len(data.signals)
    windows, free = np.sqrt(totals / count)
    return Score(float(windows), float(free))


def brief_score(arm: Arm, data: Data) -> float:
    """Return the held-out error in windows from states that two nudged replays estimate: for arms that are nearly the same."""
    if arm.constants["drive"]["torque_noise"] > 0.0:
        return score(arm, data).windows
    plants = data.plants(arm)
    observers = {payload: window_observers(arm, plant, data, BRIEF_LEVELS)[1:] for payload, plant in plants.items()}
    total, count = 0.0, 0
    for run in data.runs:
        rows = ~run.train
        first = int(np.argmax(rows))
        windows = window_replay(plants[run.payload], run, observers[run.payload], data.noise, data.interval, first)
        total += _squares(run, windows, rows, data)
        count += int(rows.sum()) * len(data.signals)
    return float(np.sqrt(total / count))


def _squares(run: Run, replayed: Floats, rows: NDArray[np.bool_], data: Data) -> float:
    scaled = (run.measured[rows] - replayed[rows]) / data.noise
    return float(np.sum(np.nan_to_num(scaled, nan=1e6) ** 2))


def _score_innovations(arm: Arm, plants: Mapping[float, Plant], data: Data, held_out: bool) -> Score:
    own = arm.constants["drive"]["torque_noise"]
    gains = {payload: observer_gains(arm, plant, data, own) for payload, plant in plants.items()}
    sigmas = {payload: innovation_sigma(plant, data.noise, own, data.interval) for payload, plant in plants.items()}
    totals = np.zeros(2)
    count = 0
    for run in data.runs:
        rows = ~run.train if held_out else run.train
        plant = plants[run.payload]
        nudged = (run.measured - replay(plant, run, data.noise, gains[run.payload])) / sigmas[run.payload]
        free = (run.measured - replay(plant, run, data.noise)) / data.noise
        totals += [np.sum(np.nan_to_num(part[rows], nan=1e6) ** 2) for part in (nudged, free)]
        count += int(rows.sum()) * len(data.signals)
    innovations, free_run = np.sqrt(totals / count)
    return Score(float(innovations), float(free_run))
