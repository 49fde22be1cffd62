"""The current of thesis eqs. 4.1 and 4.2, compiled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from flexarm_env.thesis.constants import TABLE

Floats = NDArray[np.float64]

#: Duration of the pulse [s], thesis sections 3.4 and 4.
PULSE_LENGTH = 0.5
_PULSE_START, _PULSE, _TARGET, _P, _D, _HIGH, _LOW, _LOW_SPEED, _EXTRA, _LIMIT, _KPHI = range(11)


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
        """Return the numbers and the memory of M_o that `current` takes, for a step [s]."""
        numbers = [self.pulse_start, self.pulse, self.target, self.proportional, self.derivative, self.high, self.low]
        numbers += [self.low_speed, self.compensation, self.limit, TABLE["kphi"]]
        return np.array(numbers), np.zeros(round(self.delay / step) + 1)


@njit(cache=True, error_model="numpy")
def current(numbers, past, k, time, angle, speed, torque):  # type: ignore[no-untyped-def]
    """Current [A] at step k, from arm angle [rad], motor speed [rad/s] and M_o [Nm]; past remembers M_o."""
    start = numbers[_PULSE_START]
    amps = numbers[_PULSE] if start - 1e-9 <= time < start + PULSE_LENGTH - 1e-9 else 0.0
    amps += numbers[_P] * (numbers[_TARGET] - angle) - numbers[_D] * speed
    slow = abs(speed) < numbers[_LOW_SPEED]
    if numbers[_HIGH] != 0.0 or numbers[_LOW] != 0.0:
        past[k % past.shape[0]] = torque
        late = past[(k + 1) % past.shape[0]]
        amps += (numbers[_LOW] if slow else numbers[_HIGH]) * late / numbers[_KPHI]
    if slow and speed != 0.0:
        amps += numbers[_EXTRA] if speed > 0.0 else -numbers[_EXTRA]
    return min(max(amps, -numbers[_LIMIT]), numbers[_LIMIT])
