"""The thesis's controller of the hub: proportional, with feedback of the motor's speed."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Controller, Floats
from flexarm_env.errors import InputError
from flexarm_env.thesis_drive import DERIVATIVE, GEAR_RATIO, PROPORTIONAL, command_scale

#: From nothing to the thesis's limit in 0.1 s [A/s], a period of the pinned beam.
RATE = 50.0


class PD(Controller):
    """Command = P (target − arm angle) − D motor speed (thesis eq. 4.2 without M_o).

    Args:
        arm: modelled.
        interval: control period [s].
        proportional: P [A/rad or V/rad]; the thesis's by default, scaled to the arm's limit.
        derivative: D [A s/rad or V s/rad], on the motor's speed; likewise, scaled to the gears as well.
    """

    def __init__(
        self, arm: Arm, interval: float, proportional: float | None = None, derivative: float | None = None
    ) -> None:  # fmt: skip
        super().__init__(arm, interval)
        scale = command_scale(arm)
        on_speed = scale * GEAR_RATIO / arm.constants["drive"]["gear_ratio"]
        self.proportional = scale * PROPORTIONAL if proportional is None else proportional
        self.derivative = on_speed * DERIVATIVE if derivative is None else derivative
        self._angle, self._speed = self.column("arm_angle"), self.column("motor_speed")

    def _command(self, seen: Floats) -> Floats:
        return self.proportional * (seen[:, -1] - seen[:, self._angle]) - self.derivative * seen[:, self._speed]


class RateLimitedPD(PD):
    """PD with a rate-limited command (thesis section 2.3, Fig. 2.8, and chapter 5).

    Args:
        arm: modelled.
        interval: control period [s].
        rate: largest rate of the command [A/s or V/s]. The thesis gives no number.
        proportional: as for PD.
        derivative: as for PD.
    """

    def __init__(
        self, arm: Arm, interval: float, rate: float | None = None, proportional: float | None = None,
        derivative: float | None = None,
    ) -> None:  # fmt: skip
        super().__init__(arm, interval, proportional, derivative)
        rate = command_scale(arm) * RATE if rate is None else rate
        if not rate > 0.0:
            raise InputError(f"rate {rate:g} A/s; give a positive number such as {RATE:g}")
        self.rate, self._step = rate, rate * interval

    def _start(self, count: int) -> None:
        super()._start(count)
        self._last = np.zeros(count)

    def _command(self, seen: Floats) -> Floats:
        wanted = self.clipped(super()._command(seen))
        self._last = np.minimum(np.maximum(wanted, self._last - self._step), self._last + self._step)
        return self._last
