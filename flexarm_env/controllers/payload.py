"""Estimation of the payload from the fundamental frequency of the strain (thesis chapter 5)."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.estimator import LEAST_NOISE
from flexarm_env.errors import InputError
from flexarm_env.linear import linearise

#: Payloads [kg] between which frequencies are interpolated.
LARGEST, STEPS = 0.6, 25
#: Corner of the three low-passes in series before the fit, over the unloaded arm's frequency: low enough to reject the
#: second vibration.
CORNER = 0.45
#: Time constant of the forgetting, and time between estimates [s].
MEMORY, BETWEEN = 3.0, 0.025
#: An arm is at rest within AT_REST times its readings' noise. If it is not at the start, estimation waits for WAIT time
#: constants of a low-pass.
AT_REST, WAIT = 5.0, 10.0
#: Sum of the squared filtered strain, over the noise's variance, from which an estimate is used.
ENOUGH = 2e4


def shows_payload(arm: Arm) -> bool:
    """Whether an arm has the beam and the readings in which a payload shows."""
    return arm.has("beam") and {_gage_of(arm), "motor_speed"} <= set(arm.signals)


def _gage_of(arm: Arm) -> str:
    return "strain_base" if "strain_base" in arm.signals else "strain_mid"


class PayloadEstimator:
    """Estimates the tip masses of many arms from their fundamental frequencies.

    Against the hub the beam is clamped, moving or stuck, and only the hub's acceleration drives it:
    ÿ + ω² y = −g θ̈ for the strain y and its first frequency ω. Neither friction nor the loop matters, as they would for
    the frequency at which a moving arm swings. Both sides go through the same low-passes, and their states give the
    derivatives (state-variable filters: Young, Automatica 17 (1981) 23), and ω² and g come by least squares with
    forgetting. The frequency table of the stuck arm then gives the payload.

    Args:
        arm: modelled; its known tip mass is the first estimate.
        interval: control period [s].

    Raises:
        InputError: for an arm without a beam or a gage.
    """

    def __init__(self, arm: Arm, interval: float) -> None:
        gage = _gage_of(arm)
        if not shows_payload(arm):
            raise InputError(
                f"a payload shows in strain_base or strain_mid and motor_speed, which arm '{arm.name}' lacks; add both"
            )
        self.frequencies, self.payloads = frequency_table(arm, interval)
        self._gage, self._speed = (list(arm.signals).index(signal) for signal in (gage, "motor_speed"))
        self._offset, self._gears = arm.sensors[gage]["offset"], arm.constants["drive"]["gear_ratio"]
        corner = 2.0 * np.pi * CORNER * self.frequencies[-1]
        self._corner, self._blend = corner, corner * interval / (2.0 + corner * interval)
        self._interval, self._fade = interval, np.exp(-interval / MEMORY)
        self._every = max(round(BETWEEN / interval), 1)
        noise = [max(arm.reading_noise(signal), LEAST_NOISE) for signal in (gage, "motor_speed")]
        self._rest = AT_REST * np.array(noise)[:, None] / [[1.0], [self._gears]]
        self._enough = ENOUGH * noise[0] ** 2
        #: Regularisation of g by the tachometer's noise, so that it is not estimated from noise on a stuck hub.
        self._ridge = (corner * noise[1] / self._gears) ** 2

    def start(self, count: int) -> None:
        """Reset the estimates."""
        #: Inputs and outputs of the low-passes, for strain [V] and hub speed [rad/s].
        self._stages = np.zeros((4, 2, count))
        self._squares = np.zeros((3, count))
        self._products = np.zeros((2, count))
        self._samples = 0
        self.known = np.zeros(count, dtype=bool)
        self.frequency = np.full(count, self.frequencies[-1])
        self.payload = np.full(count, self.payloads[-1])

    def update(self, seen: Floats) -> Floats:
        """Update the estimates by readings (count, signals, …); return payloads (count,) [kg], measured ones where `known`."""
        stages = self._stages
        enters = stages.copy()
        stages[0, 0], stages[0, 1] = seen[:, self._gage] - self._offset, seen[:, self._speed] / self._gears
        if not self._samples:
            self._wait = np.where((np.abs(stages[0]) < self._rest).all(axis=0), 0.0, WAIT / (self._corner * self._interval))
        for i in range(1, 4):
            stages[i] += self._blend * (stages[i - 1] + enters[i - 1] - 2.0 * enters[i])
        strain, speed = stages[:, 0], stages[:, 1]
        bend = self._corner**2 * (strain[1] - 2.0 * strain[2] + strain[3])
        turn = self._corner * (speed[2] - speed[3])
        weight = self._samples >= self._wait
        self._squares = self._fade * self._squares + weight * np.stack([strain[3] ** 2, strain[3] * turn, turn**2])
        self._products = self._fade * self._products + weight * np.stack([strain[3] * bend, turn * bend])
        self._samples += 1
        if self._samples % self._every == 0:
            self._estimate()
        return self.payload

    def _estimate(self) -> None:
        """Solve the normal equations of bend = −ω² strain − g turn."""
        ready = self._squares[0] > self._enough
        bends, mixed, turns = self._squares[:, ready]
        turns = turns + self._ridge
        square = (self._products[1, ready] * mixed - self._products[0, ready] * turns) / (bends * turns - mixed**2)
        self.known |= ready
        self.frequency[ready] = np.sqrt(np.maximum(square, 0.0)) / (2.0 * np.pi)
        self.payload[ready] = np.interp(self.frequency[ready], self.frequencies, self.payloads)


def frequency_table(arm: Arm, interval: float) -> tuple[Floats, Floats]:
    """Tabulate fundamental frequencies (steps,) [Hz] of the stuck arm, rising, and their tip masses (steps,) [kg]."""
    payloads = np.linspace(0.0, LARGEST, STEPS) + arm.value("beam.tip_mass")
    found = [linearise(arm.with_values({"beam.tip_mass": mass}), "stuck", interval).vibrations()[0] for mass in payloads]
    return np.array([frequencies[0] for frequencies in found])[::-1], payloads[::-1]
