"""Vibration suppression on estimated strain and speed, in place of a low-pass and its phase lag (thesis chapter 5)."""

from __future__ import annotations

from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.estimator import Estimator
from flexarm_env.controllers.vibration import VibrationSuppression

#: Vibrations up to this [Hz] are estimated. Their strain is fed back directly, without a regulator designed on it as in LQG.
HIGHEST_FREQUENCY = 48.0


class FilteredVibrationSuppression(VibrationSuppression):
    """The thesis's controller by regions of speed, on speed and M_o from a Kalman filter.

    The filter uses the arm's model and the command, so it delays neither strain nor speed, as a low-pass would. On the
    thesis's sensors it removes about a fifth of the speed's noise. Its strain is about as accurate as the gage: friction is
    unknown, and 200 samples a second leave little to average over.

    Args:
        arm: modelled.
        interval: control period [s].
        options: as for VibrationSuppression.
    """

    def __init__(self, arm: Arm, interval: float, **options: Any) -> None:
        super().__init__(arm, interval, **options)
        self.estimator = Estimator(arm, interval, HIGHEST_FREQUENCY)

    def _start(self, count: int) -> None:
        super()._start(count)
        self.estimator.start(count)

    def motion(self, seen: Floats) -> tuple[Floats, Floats]:
        """Estimate motor speed [rad/s] and M_o [Nm, motor side], each (count,)."""
        self.estimator.correct(seen[:, :-1])
        strain = self.estimator.reading(self._gage)
        return self.estimator.reading("motor_speed"), self._torque_per_strain * strain

    def _sent(self, command: Floats) -> None:
        self.estimator.predict(command)
