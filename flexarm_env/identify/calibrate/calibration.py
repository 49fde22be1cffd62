"""A calibrated arm, with all that its intervals need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.least_squares import Solution
from flexarm_env.identify.calibrate.objective import Objective, unexplained_share
from flexarm_env.identify.calibrate.parameters import FitParameters

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Calibration:
    """A calibrated arm and where its calibration ended.

    Attributes:
        arm: with the calibrated values.
        solution: where the minimisation ended.
        objective: of its last pass.
        moved: (x,) how far the values moved when the held-out part came in, for the share that is unexplained, and from one
            minimum to the next; None before.
        narrow: Jacobian (rows, x) by narrow differences where the values ended, weighted as the objective; None before.
    """

    arm: Arm
    solution: Solution
    objective: Objective
    moved: Floats | None = None
    narrow: Floats | None = None

    @property
    def parameters(self) -> FitParameters:
        """The values that were fitted."""
        return self.objective.parameters

    @property
    def rms_errors(self) -> Floats:
        """The rms errors (runs, signals) that are left, at least the noise."""
        return self.objective.rms_errors_in(self.solution.residual)

    @property
    def unexplained(self) -> float:
        """The share of the squared errors that the noise of the sensors, or chance, does not explain."""
        dataset = self.objective.dataset
        return unexplained_share(self.rms_errors / (dataset.settings.errors.nothing_left * dataset.noise))
