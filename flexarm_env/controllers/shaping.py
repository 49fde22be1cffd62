"""Input shaping: each step of the target is split into parts, timed so that their vibrations cancel."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.pd import PD
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.linear import linearise

SHAPERS = {"zv": 1, "zvd": 2}


class ShapedPD(PD):
    """PD on a target that is shaped for the slowest vibration of the stuck arm.

    The moving arm's vibration (9 Hz, pinned) needs no shaping: the loop damps it to a ratio of 0.4 within a cycle. Relative
    to the hub, the beam is always clamped and driven by the hub's acceleration only. A hub motion shaped for the clamped
    frequency (2.4 Hz) leaves the beam at rest; once the hub is stuck, nothing else damps it. Before the first sample the
    target is assumed to have been at the arm's angle.

    Args:
        arm: modelled.
        interval: control period [s].
        shaper: "zv" (zero vibration; two steps) or "zvd" (and zero derivative: half as sensitive to the frequency; three
            steps), after Singer and Seering, J. Dyn. Sys. Meas. Control 112 (1990) 76.
        mode: of the modelled arm with the vibration to shape for, "stuck" (clamped beam) or "moving" (pinned).
        proportional: as for PD.
        derivative: as for PD.
    """

    def __init__(
        self, arm: Arm, interval: float, shaper: str = "zv", mode: str = "stuck",
        proportional: float | None = None, derivative: float | None = None,
    ) -> None:  # fmt: skip
        super().__init__(arm, interval, proportional, derivative)
        if shaper not in SHAPERS:
            raise InputError(f"no shaper '{shaper}'{did_you_mean(shaper, SHAPERS)}")
        frequency, damping = slowest_vibration(arm, mode, interval)
        self.weights = shaper_weights(shaper, frequency, damping, interval)

    def _start(self, count: int) -> None:
        super()._start(count)
        self._targets = np.zeros((len(self.weights), count))
        self._now = -1

    def _command(self, seen: Floats) -> Floats:
        return super()._command(np.column_stack([seen[:, :-1], self.shaped(seen)]))

    def shaped(self, seen: Floats) -> Floats:
        """Shape the targets of this sample: (count,) [rad]."""
        length = len(self.weights)
        if self._now < 0:
            self._targets[:] = seen[:, self._angle]
        self._now = (self._now + 1) % length
        self._targets[self._now] = seen[:, -1]
        ages = np.flatnonzero(self.weights)
        # a sum over a handful of rows, in the same order for any number of arms
        return np.add.reduce(self.weights[ages, None] * self._targets[self._now - ages], axis=0)


def slowest_vibration(arm: Arm, mode: str, interval: float) -> tuple[float, float]:
    """Compute frequency [Hz] and damping ratio of the slowest vibration of an arm in a mode.

    Raises:
        InputError: for an arm that does not vibrate.
    """
    frequencies, damping = linearise(arm, mode, interval).vibrations()
    if not len(frequencies):
        raise InputError(f"arm '{arm.name}' has no vibration to shape for: it has no beam, or too damped a one; use 'pd'")
    # rounding can turn an undamped pole's ratio negative
    return float(frequencies[0]), max(float(damping[0]), 0.0)


def shaper_weights(shaper: str, frequency: float, damping: float, interval: float) -> Floats:
    """Compute the weights (taps,) on the target of 0, 1, … samples ago; their sum is 1.

    Exact on the samples: zero vibration at the pole z = exp(−ζω + jω√(1−ζ²))·interval requires Σ a_n z^−n = 0, and
    the second step, half a period later, is split over the two samples beside it (Tuttle and Seering, Proc. American
    Control Conf. (1994) 2533).

    Raises:
        InputError: for a vibration too slow, too fast for the samples, or too damped to have a period.
    """
    if not (0.0 <= damping < 1.0 and 0.0 < frequency * interval < 0.25):
        raise InputError(
            f"cannot shape for {frequency:g} Hz with damping ratio {damping:g}; "
            f"needed are 0 to {0.25 / interval:g} Hz and a ratio of 0 to 1"
        )
    rate = 2.0 * np.pi * frequency
    pole = np.exp(complex(-damping, np.sqrt(1.0 - damping**2)) * rate * interval)
    before = int(np.floor(np.pi / np.angle(pole)))
    powers = pole ** -np.array([0.0, before, before + 1.0])
    steps = np.linalg.solve(np.array([np.ones(3), powers.real, powers.imag]), [1.0, 0.0, 0.0])
    once = np.zeros(before + 2)
    once[[0, before, before + 1]] = steps
    weights = once
    for _ in range(SHAPERS[shaper] - 1):
        weights = np.convolve(weights, once)
    return weights
