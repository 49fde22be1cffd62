"""The levels of process noise that one calibration goes through, each from where the one before ended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.least_squares import Ending, Goal, Solution, StepSizes, minimise
from flexarm_env.identify.calibrate.objective import Objective, objective_at
from flexarm_env.identify.calibrate.parameters import FitParameters
from flexarm_env.identify.replay.dataset import Dataset

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Schedule:
    """Levels of process noise above an arm's own, and passes at its own.

    Attributes:
        arm: where to start.
        dataset: the recordings.
        parameters: the fitted values.
        iterations: most Jacobians at each level.
    """

    arm: Arm
    dataset: Dataset
    parameters: FitParameters
    iterations: int

    def run(self, levels: Sequence[float], passes: int, most: float = np.inf) -> Calibration | None:
        """Calibrate through levels [Nm], then at the arm's own torque noise.

        What is left of both is skipped once an arm is near the noise, where its error is smooth. The last pass is narrow. A level
        that leaves too much is taken anew from the arm's values where these do not: a little that a level with more feedback
        moved may be much of a rough error.

        Args:
            levels: of process noise.
            passes: at the arm's own; none where a level is all that is wanted.
            most: error over the noise under an observer; a level that leaves more ends the calibration without a result, as soon
                as its remaining Jacobians are not enough.
        """
        own, settings = self.arm.constants["drive"]["torque_noise"], self.dataset.settings
        begun = x = self.parameters.position(self.arm)
        steps = self.parameters.step_sizes(x, settings.parameters)
        found: tuple[Objective, Solution] | None = None
        for noise in (*levels, *(passes - 1) * (own,)):
            here = self._objective(x, own) if passes else None
            if here is not None and here.excess_factor < settings.errors.near:
                break
            objective = here if here is not None and noise == own else self._objective(x, noise)
            goal = Goal(objective.square_over_noise, most**2) if most < np.inf and noise > own else None
            found = objective, self._minimise(objective, x, steps, last=False, goal=goal)
            if goal and goal.measure(found[1].residual) > goal.most:
                again = None if x is begun else self._objective(begun, noise)
                if again is None or again.excess_factor > most:
                    return None
                found = again, self._minimise(again, begun, steps, last=False)
            x, steps = self.parameters.within(found[1].x), found[1].steps
        if passes:
            objective = self._objective(x, own)
            found = objective, self._finer(objective, self._minimise(objective, x, steps, last=True))
        assert found is not None
        return Calibration(self.parameters.apply(self.arm, found[1].x), found[1], found[0])

    def _objective(self, x: Floats, torque_noise: float) -> Objective:
        """Build an objective that weighs errors by those at x."""
        objective = objective_at(self.arm, self.dataset, self.parameters, torque_noise)
        return objective.weighted_by(self.parameters.apply(self.arm, x))

    def _finer(self, objective: Objective, found: Solution) -> Solution:
        """Continue over finer differences what ends off the noise, but not so far that an effect must be missing.

        A difference of a beam's constant turns a fast vibration by a radian at the end of a long run: it is no slope then.
        """
        settings = self.dataset.settings
        if not settings.errors.near**2 < objective.square_over_noise(found.residual) < settings.errors.far_off**2:
            return found
        fine = found.steps.finer(settings.least_squares.fine)
        ending = Ending(self.iterations, settings.calibrating.final_tolerance)
        again = minimise(objective.residuals, found.x, objective.weights.prior, fine, settings.least_squares, ending)
        return replace(again, steps=found.steps) if again.cost < found.cost else found

    def _minimise(self, objective: Objective, x: Floats, steps: StepSizes, last: bool, goal: Goal | None = None) -> Solution:
        """Minimise at one level; over narrow differences at the last."""
        settings = self.dataset.settings
        numbers, calibrating = settings.least_squares, settings.calibrating
        tolerance = calibrating.final_tolerance if last else calibrating.tolerance
        steps = steps.narrowed(numbers.narrow) if last else steps
        ending = Ending(self.iterations, tolerance, goal)
        return minimise(objective.residuals, x, objective.weights.prior, steps, numbers, ending)
