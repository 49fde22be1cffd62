"""A model: effects, a calibrated arm that has them, and its errors."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.forecast_fit import fit_forecasts
from flexarm_env.identify.calibrate.parameters import FitParameters
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.density import first_disturbances
from flexarm_env.identify.replay.error_measure import Score, score


@dataclass(frozen=True)
class Model:
    """Effects that an arm was given, the calibrated arm, and its errors.

    Attributes:
        effects: those under judgement: the ones just added, or all that were accepted once a trace has taken the model.
        calibration: of the arm that has them.
        score: errors on the held-out part.
        fitted_score: errors on the fitted part.
    """

    effects: tuple[str, ...]
    calibration: Calibration
    score: Score
    fitted_score: Score

    @property
    def arm(self) -> Arm:
        """The calibrated arm."""
        return self.calibration.arm

    @property
    def at_bound(self) -> bool:
        """Whether the size of one of its effects ran to the end of its range: none explains the data."""
        return sizes_at_bound(self.arm, self.calibration.parameters, self.effects)

    @property
    def numbers(self) -> int:
        """Number of calibrated numbers, constants and those of effects."""
        return len(self.calibration.parameters)

    @property
    def quantities(self) -> int:
        """Number of quantities, such as angle, speed and time, on which the laws of its effects depend."""
        known = self.arm.known
        return sum(known[name].quantities() for name in self.effects)

    def error_over(self, other: Model) -> float:
        """Compute the ratio of its errors in windows to those of another, on the fitted or the held-out part, the larger one."""
        pairs = ((self.score, other.score), (self.fitted_score, other.fitted_score))
        return max(own.windows / its.windows for own, its in pairs)

    @functools.cached_property
    def forecast_cost(self) -> float:
        """Negative log density of its forecasts of all of the data, once its values suit those.

        A forecast is corrected by readings up to a fraction of a second before it, under the disturbances that make the data
        likeliest. Where a model lacks more, it tells what happens at each moment, and no whole run has to hold.
        """
        dataset = self.calibration.objective.dataset.nothing_held_out()
        return fit_forecasts(self.arm, self.calibration.parameters, dataset, first_disturbances(self.arm, dataset)).cost

    def bic(self, dataset: Dataset) -> float:
        """Compute the Bayesian information criterion on all of the data (Schwarz, Ann. Stat. 6 (1978) 461).

        The held-out part alone shows whether an effect is missing. More readings decide better between two rivals near the noise.
        """
        fitted, held = dataset.readings(held_out=False), dataset.readings(held_out=True)
        errors = fitted * self.fitted_score.windows**2 + held * self.score.windows**2
        return errors + self.numbers * math.log(fitted + held)


def sizes_at_bound(arm: Arm, parameters: FitParameters, effects: Sequence[str]) -> bool:
    """Whether the size of one of some effects is at the end of its range.

    What has no null may end there, such as the damping of a stop that has none.

    Args:
        arm: the calibrated arm.
        parameters: of its values.
        effects: names.
    """
    for parameter in parameters:
        section, name, *keys = parameter.path.split(".")
        is_size = section == "effects" and name in effects and arm.known[name].parameters[keys[0]].null is not None
        if is_size and arm.value(parameter.path) in (parameter.low, parameter.high):
            return True
    return False


def judge(effects: tuple[str, ...], calibration: Calibration, dataset: Dataset) -> Model:
    """Measure the errors of a calibrated arm."""
    arm = calibration.arm
    return Model(effects, calibration, score(arm, dataset), score(arm, dataset, held_out=False))
