"""A reference that moves to each new target along a polynomial of fifth degree, without a jump of its acceleration."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.controllers.base import Floats

#: Largest speed of the polynomial over distance / duration, and largest acceleration over distance / duration².
PEAK_SPEED, PEAK_ACCELERATION = 15.0 / 8.0, 10.0 / math.sqrt(3.0)


class QuinticReference:
    """References of many arms: angle, speed and acceleration, continuous through every change of the target.

    The duration of a move from rest is the shortest within a largest speed and acceleration (Biagiotti and Melchiorri,
    Trajectory Planning for Automatic Machines and Robots (2008), section 2.1.7). A target that changes on the way starts a
    polynomial at the present angle, speed and acceleration.

    Args:
        speed: largest of a move from rest [rad/s].
        acceleration: largest of a move from rest [rad/s²].
        interval: control period [s].
    """

    def __init__(self, speed: float, acceleration: float, interval: float) -> None:
        self.speed, self.acceleration, self.interval = speed, acceleration, interval

    def start(self, count: int) -> None:
        """Clear the references; the first update sets them at rest at the arms' angles."""
        self._fresh = True
        self._target, self._since, self._duration = np.zeros(count), np.zeros(count), np.full(count, self.interval)
        self._powers = np.zeros((6, count))

    def update(self, angle: Floats, target: Floats) -> tuple[Floats, Floats, Floats]:
        """Move on by a sample: angle [rad], speed [rad/s] and acceleration [rad/s²], each (count,).

        Args:
            angle: of the arms (count,), where a first reference starts.
            target: (count,) [rad].
        """
        if self._fresh:
            self._fresh = False
            self._powers[0], self._target = angle, angle.copy()
        new = target != self._target
        if new.any():
            self._aim(new, target)
        # the reference of a sample is what its command, held until the next one, should reach
        self._since = self._since + self.interval
        return self._now()

    def _now(self) -> tuple[Floats, Floats, Floats]:
        p, t = self._powers, np.minimum(self._since / self._duration, 1.0)
        angle = p[0] + t * (p[1] + t * (p[2] + t * (p[3] + t * (p[4] + t * p[5]))))
        speed = p[1] + t * (2.0 * p[2] + t * (3.0 * p[3] + t * (4.0 * p[4] + t * 5.0 * p[5])))
        bend = 2.0 * p[2] + t * (6.0 * p[3] + t * (12.0 * p[4] + t * 20.0 * p[5]))
        over = t >= 1.0
        resting = np.where(over, self._target, angle)
        return resting, np.where(over, 0.0, speed / self._duration), np.where(over, 0.0, bend / self._duration**2)

    def _aim(self, new: Floats, target: Floats) -> None:
        """Lay the polynomials of the arms with a new target, in shares of their durations."""
        angle, speed, acceleration = self._now()
        way = target - angle
        by_speed = PEAK_SPEED * np.abs(way) / self.speed
        by_acceleration = np.sqrt(PEAK_ACCELERATION * np.abs(way) / self.acceleration)
        duration = np.maximum(np.maximum(by_speed, by_acceleration), self.interval)
        v, a = speed * duration, 0.5 * acceleration * duration**2
        rest = way - v - a
        # end at the target with neither speed nor acceleration: three equations for the three highest powers
        ends = np.array([rest, -(v + 2.0 * a), -2.0 * a])
        cubic = 10.0 * ends[0] - 4.0 * ends[1] + 0.5 * ends[2]
        quartic = -15.0 * ends[0] + 7.0 * ends[1] - ends[2]
        quintic = 6.0 * ends[0] - 3.0 * ends[1] + 0.5 * ends[2]
        made = np.array([angle, v, a, cubic, quartic, quintic])
        self._powers = np.where(new, made, self._powers)
        self._duration = np.where(new, duration, self._duration)
        self._target = np.where(new, target, self._target)
        self._since = np.where(new, 0.0, self._since)
