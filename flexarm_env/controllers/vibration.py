"""The thesis's vibration suppression: PD plus feedback of the beam's torque on the hub, by region of speed (chapter 4)."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.pd import PD
from flexarm_env.errors import InputError

#: Motor speed between low and high speed [rad/s] (thesis section 4.3).
LOW_SPEED = 0.03
#: Torque M_o per reading of the gage at mid-beam [Nm/V]: thesis section 4.5 with K = 1.18 in A/V, times kφ. The text gives
#: K no unit; in Nm/V the loop swings between its limits on the consistent model, in A/V it reproduces Fig. 4.21.
TORQUE_PER_STRAIN = 1.18 * 0.33


class VibrationSuppression(PD):
    """Command = P error − D motor speed + K_mo M_o(t − t_d) / kφ (thesis eqs. 4.1, 4.2), K_mo by region of speed.

    M_o, the beam's torque on the motor [Nm, motor side] (thesis eq. 4.4, with erratum 5), is the moment at the beam's
    root over the gear ratio. The gage at the base measures that moment; `torque_per_strain` takes M_o = K × strain at
    mid-beam instead, as on the rig (thesis section 4.5). P = D = 0 leaves eq. 4.1's term alone, to be added to a pulse.

    Args:
        arm: modelled.
        interval: control period [s].
        high_gain: K_mo while |motor speed| is low_speed or more; −1 damps there (thesis section 4.2).
        low_gain: K_mo below; +1 damps there (thesis section 4.3).
        delay: t_d [s], in whole and parts of samples; 0 in the pinned modes, 0.074 suits the clamped model only.
        low_speed: of the motor [rad/s] (thesis section 4.3).
        friction_compensation: whether the Coulomb friction is compensated at low speed (section 4.3).
        torque_per_strain: K [Nm/V] on the gage at mid-beam, or None for the gage at the base.
        proportional: as for PD.
        derivative: as for PD.
    """

    def __init__(
        self, arm: Arm, interval: float, high_gain: float = -1.0, low_gain: float = 1.0, delay: float = 0.0,
        low_speed: float = LOW_SPEED, friction_compensation: bool = True, torque_per_strain: float | None = None,
        proportional: float | None = None, derivative: float | None = None,
    ) -> None:  # fmt: skip
        self._gage = "strain_base" if torque_per_strain is None else "strain_mid"
        self.needs = ("arm_angle", "motor_speed", self._gage)
        super().__init__(arm, interval, proportional, derivative)
        if not (math.isfinite(delay) and delay >= 0.0):
            raise InputError(f"delay {delay:g} s; give zero or a positive time such as 0.026")
        gears = arm.constants["drive"]["gear_ratio"]
        if torque_per_strain is None:
            sensor = arm.sensors[self._gage]
            self._torque_per_strain, self._zero = 1.0 / (sensor["gain"] * gears), sensor["offset"]
        else:
            self._torque_per_strain, self._zero = torque_per_strain, arm.sensors[self._gage]["offset"]
        self.high_gain, self.low_gain, self.low_speed = high_gain, low_gain, low_speed
        self.regions = (0.5 * low_speed, 2.0 * low_speed)
        # M_o and kφ stand on the motor's side, as does T_c/N
        self._command_per_torque = gears / self.hub_torque_per_command
        self._compensation = self.coulomb_torque() / self.hub_torque_per_command if friction_compensation else 0.0
        self._whole, self._part = divmod(delay / interval, 1.0)
        self._strain = self.column(self._gage)

    def _start(self, count: int) -> None:
        super()._start(count)
        self._past = np.zeros((int(self._whole) + 2, count))
        self._now = 0

    def _delayed(self, torque: Floats) -> Floats:
        """Look up M_o of t_d ago (count,), interpolated between samples."""
        if self._whole == 0 and self._part == 0.0:
            return torque
        length = len(self._past)
        self._past[self._now] = torque
        early, late = self._past[(self._now + 1) % length], self._past[(self._now + 2) % length]
        self._now = (self._now + 1) % length
        return late + self._part * (early - late)

    def motion(self, seen: Floats) -> tuple[Floats, Floats]:
        """Compute motor speed [rad/s] and M_o [Nm, motor side], each (count,)."""
        return seen[:, self._speed], self._torque_per_strain * (seen[:, self._strain] - self._zero)

    def _command(self, seen: Floats) -> Floats:
        speed, torque = self.motion(seen)
        low = np.abs(speed) < self.low_speed
        added = np.where(low, self.low_gain, self.high_gain) * self._command_per_torque * self._delayed(torque)
        return super()._command(seen) + added + low * np.sign(speed) * self._compensation
