"""A calibrated arm, with all that its intervals need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.least_squares import Solution
from flexarm_env.identify.calibrate.objective import Objective
from flexarm_env.identify.calibrate.parameters import FitParameters

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Calibration:
    """A calibrated arm and where its calibration ended.

    Attributes:
        arm: with the calibrated values.
        solution: where the minimisation ended.
        objective: of its last pass.
        moved: (x,) how far the values moved when the held-out part came in, and from one minimum to the next; None before.
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
