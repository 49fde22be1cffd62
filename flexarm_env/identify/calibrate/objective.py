"""Residuals of an arm against a dataset as a function of its fitted values, at one level of process noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import Stated
from flexarm_env.identify.calibrate.parameters import FitParameters
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.error_measure import error_measure
from flexarm_env.identify.replay.observer import innovation_noise, observer_gains
from flexarm_env.identify.replay.readings import rms_of
from flexarm_env.identify.replay.replay import replay
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.start_bank import StartBank
from flexarm_env.identify.settings import FAILED_ERROR
from flexarm_env.identify.threads import in_threads
from flexarm_env.plant.plant import Plant

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Weights:
    """Weights of errors and values.

    Attributes:
        sigma: (runs, signals) by which errors are divided, SI units.
        prior: (x,) standard deviation of each value.
        noise: (runs, signals) what the noise of the sensors alone leaves of the errors, in the unit of sigma.
    """

    sigma: Floats
    prior: Floats
    noise: Floats


@dataclass(frozen=True)
class ObserverBank:
    """Observer gains, designed once for each structure of an arm and kept while its numbers are fitted.

    Attributes:
        designed: physical gains by what recordings state, effects and size of the state.
    """

    designed: dict[tuple[Stated, tuple[str, ...], int, int], Floats] = field(default_factory=dict)

    def gains(self, arm: Arm, plant: Plant, run: Run, dataset: Dataset, torque_noise: float) -> Floats:
        """Look up the gains for an arm's structure; design them for this arm where there are none yet."""
        key = (run.stated, tuple(arm.effects), plant.modes, plant.states)
        if key not in self.designed:
            self.designed[key] = observer_gains(arm, plant, dataset, torque_noise)
        return self.designed[key]


@dataclass(frozen=True)
class Objective:
    """The cost of a calibration: whitened replay errors and priors.

    Attributes:
        arm: the parameters replace its values.
        dataset: the recordings.
        parameters: the fitted ones.
        torque_noise: process noise [Nm]; 0 for free replays.
        weights: of errors and values.
        reduced: whether beams are left their slow vibrations (see `Dataset.plants`).
        observers: gains of the corrected replays.
        starts: initial states of the recordings.
    """

    arm: Arm
    dataset: Dataset
    parameters: FitParameters
    torque_noise: float
    weights: Weights
    reduced: bool = False
    observers: ObserverBank = field(default_factory=ObserverBank, repr=False, compare=False)
    starts: StartBank = field(default_factory=StartBank, repr=False, compare=False)

    def residual(self, x: Floats) -> Floats:
        """Compute the errors over sigma (rows,), run by run, sample by sample, signal by signal."""
        return self.residual_of(self.parameters.apply(self.arm, x))

    def residuals(self, points: Sequence[Floats]) -> list[Floats]:
        """Compute the residual at each of some points (x,)."""
        return self._residuals_of([self.parameters.apply(self.arm, x) for x in points])

    def residual_of(self, arm: Arm) -> Floats:
        """Compute the residual of another arm under the same weights."""
        return self._residuals_of([arm])[0]

    def _residuals_of(self, arms: Sequence[Arm]) -> list[Floats]:
        return [self._whitened(errors) for errors in self._errors_of_each(arms, self.dataset.fitted)]

    def _whitened(self, errors: Sequence[Floats]) -> Floats:
        return self._bounded([(error / sigma).ravel() for error, sigma in zip(errors, self.weights.sigma, strict=True)])

    def residual_by_own_observers(self, arm: Arm) -> Floats:
        """Compute the residual of an arm whose values are not near those that the kept observers are designed for."""
        return replace(self, observers=ObserverBank()).residual_of(arm)

    def held_out_residual_of(self, arm: Arm) -> Floats:
        """Compute the residual of another arm on the part held out, from observers of its own."""
        own = replace(self, observers=ObserverBank(), starts=StartBank())
        runs = self.dataset.runs
        triples = zip(runs, own._errors(arm, runs), self.weights.sigma, strict=True)
        return self._bounded([(error[~run.train] / sigma).ravel() for run, error, sigma in triples])

    def errors_of(self, arm: Arm) -> list[Floats]:
        """Compute measured less replayed (samples, signals) of the fitted part of each run, SI units; 0 where not measured."""
        return self._errors(arm, self.dataset.fitted)

    def weighted_by(self, arm: Arm, narrow_priors: bool = True) -> Objective:
        """Weigh errors by those of an arm, and constants the more the less is explained.

        Errors that a model cannot explain are correlated: those of one moment count once, however many samples there are.
        Without that a search strays to constants that no machine has.

        Args:
            arm: its errors are the measure.
            narrow_priors: whether the priors of constants are narrowed so.
        """
        dataset = self.dataset
        sigma, noise = self.rms_errors_of(arm), self._noise_of(arm)
        share = unexplained_share(sigma / noise) if narrow_priors else 0.0
        together = 1.0 + share * max(dataset.settings.calibrating.memory / dataset.interval - 1.0, 0.0)
        narrower = np.array([np.sqrt(together) if p.is_constant else 1.0 for p in self.parameters])
        return replace(self, weights=Weights(sigma, self.parameters.priors / narrower, noise))

    def rms_errors_of(self, arm: Arm) -> Floats:
        """Compute the rms error (runs, signals) of the fitted part, at least the noise."""
        return self._rms(self.errors_of(arm))

    def _rms(self, errors: Sequence[Floats]) -> Floats:
        found = np.array([rms_of(one, run.measured) for one, run in zip(errors, self.dataset.fitted, strict=True)])
        return np.maximum(np.nan_to_num(found, nan=np.inf, posinf=FAILED_ERROR), self.dataset.noise)

    def _noise_of(self, arm: Arm) -> Floats:
        """Compute what the noise of the sensors alone leaves (runs, signals) under the observers of an arm."""
        dataset = self.dataset
        if self.torque_noise == 0.0:
            return np.broadcast_to(dataset.noise, (len(dataset.runs), len(dataset.signals)))
        plants = dataset.plants(arm, self.reduced)
        left = {}
        for run in dataset.fitted:
            if run.stated not in left:
                plant = plants[run.stated]
                gains = self.observers.gains(arm, plant, run, dataset, self.torque_noise)
                left[run.stated] = innovation_noise(plant, dataset, gains)
        return np.array([left[run.stated] for run in dataset.fitted])

    @property
    def excess_factor(self) -> float:
        """The rms of the weights over what noise alone leaves: 1 where errors are weighed by that alone."""
        return float(np.sqrt(np.mean((self.weights.sigma / self.weights.noise) ** 2)))

    def rms_errors_in(self, residual: Floats) -> Floats:
        """Compute the rms error (runs, signals) in a residual (rows,), at least the noise."""
        ends = np.cumsum([run.measured.size for run in self.dataset.fitted])[:-1]
        triples = zip(np.split(residual, ends), self.dataset.fitted, self.weights.sigma, strict=True)
        return self._rms([part.reshape(run.measured.shape) * sigma for part, run, sigma in triples])

    def square_over_noise(self, residual: Floats) -> float:
        """Compute the mean square of the errors of a residual (rows,) over what noise alone leaves, all signals alike."""
        return float(np.mean((self.rms_errors_in(residual) / self.weights.noise) ** 2))

    def rows_of(self, sigma: Floats) -> Floats:
        """Repeat numbers (runs, signals) for each row of the residual (rows,)."""
        pairs = zip(self.dataset.fitted, sigma, strict=True)
        return np.concatenate([np.broadcast_to(own, run.measured.shape).ravel() for run, own in pairs])

    def _bounded(self, parts: Sequence[Floats]) -> Floats:
        largest = self.dataset.settings.least_squares.largest_residual
        return np.clip(np.nan_to_num(np.concatenate(parts), nan=largest), -largest, largest)

    def _errors(self, arm: Arm, runs: Sequence[Run]) -> list[Floats]:
        return self._errors_of_each([arm], runs)[0]

    def _errors_of_each(self, arms: Sequence[Arm], runs: Sequence[Run]) -> list[list[Floats]]:
        """Compute the errors (samples, signals) of each run by each of some arms, in threads where there are some."""
        every = self.dataset.plants_of(arms, self.reduced)
        places = range(len(runs))
        tasks = [(arm, plants[runs[place].stated], place) for arm, plants in zip(arms, every, strict=True) for place in places]
        errors = in_threads(lambda arm, plant, place: self._errors_by(arm, plant, runs[place], place), tasks)
        return [errors[first : first + len(runs)] for first in range(0, len(errors), len(runs))]

    def _errors_by(self, arm: Arm, plant: Plant, run: Run, place: int) -> Floats:
        dataset, own = self.dataset, plant.with_own_state()
        gains = self.observers.gains(arm, own, run, dataset, self.torque_noise) if self.torque_noise > 0.0 else None
        start = self.starts.start(own, run, place, dataset)
        errors = run.errors(replay(own, run, dataset, gains, start))
        if not error_measure(arm).judges_free_run:
            errors[: round(dataset.settings.preparation.settling / dataset.interval)] = 0.0
        return errors


def unexplained_share(errors: Floats) -> float:
    """Compute the share of squared errors, over the noise, that noise does not explain: 0 for errors of its size."""
    return max(1.0 - 1.0 / float(np.mean(errors**2)), 0.0)


def objective_at(arm: Arm, dataset: Dataset, parameters: FitParameters, torque_noise: float, reduced: bool = False) -> Objective:
    """Build an objective at one level of process noise [Nm], with errors of unit weight."""
    sigma = np.ones((len(dataset.runs), len(dataset.signals)))
    return Objective(arm, dataset, parameters, torque_noise, Weights(sigma, parameters.priors, sigma), reduced)
