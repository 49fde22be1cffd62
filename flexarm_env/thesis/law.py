"""The control law of the current, thesis eqs. 4.1 and 4.2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.thesis.constants import TABLE

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Law:
    """A pulse of current, PD on a target, and K_mo M_o(t − t_d) by region of speed (thesis eq. 4.2).

    Attributes:
        pulse_start: [s].
        pulse: [A], over 0.5 s.
        target: [rad].
        proportional: [A/rad], on the arm's angle.
        derivative: [A s/rad], on the motor's speed.
        high: K_mo at high speed.
        low: K_mo at low speed.
        low_speed: of the motor [rad/s].
        compensation: [A], along the motion at low speed.
        delay: t_d [s].
        limit: [A].
    """

    pulse_start: float = 0.0
    pulse: float = 0.0
    target: float = 0.0
    proportional: float = 0.0
    derivative: float = 0.0
    high: float = 0.0
    low: float = 0.0
    low_speed: float = 0.03
    compensation: float = 0.0
    delay: float = 0.0
    limit: float = np.inf

    def packed(self, step: float) -> tuple[Floats, Floats]:
        """Pack the law's numbers and an empty store of M_o for `kernels.current`, at a step [s]."""
        numbers = [self.pulse_start, self.pulse, self.target, self.proportional, self.derivative, self.high, self.low]
        numbers += [self.low_speed, self.compensation, self.limit, TABLE["kphi"]]
        return np.array(numbers), np.zeros(round(self.delay / step) + 1)
