"""A controller in closed loop with the plant, sample by sample, as on the rig."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from flexarm_env.plant import layout

INTERVAL = 0.005
SLEW = np.deg2rad(100.0)


@dataclass
class Run:
    """What happened: true quantities (samples, signals) in the order of the arm's signals, commands and targets."""

    truth: np.ndarray
    commands: np.ndarray
    targets: np.ndarray

    @property
    def error(self):
        """Hub angle less target [deg]."""
        return np.rad2deg(self.truth[:, 0] - self.targets)

    def residual(self, seconds=1.0):
        """Strain at mid-beam over the last seconds, rms [V]."""
        return float(np.sqrt(np.mean(self.truth[-round(seconds / INTERVAL) :, 2] ** 2)))

    def settled(self, band=1.0):
        """Time [s] after which the hub stays within the band [deg]; infinite if it ends outside."""
        outside = np.flatnonzero(np.abs(self.error) > band)
        if not len(outside):
            return 0.0
        return np.inf if outside[-1] == len(self.error) - 1 else (outside[-1] + 1) * INTERVAL


def close(arm, controller, targets, noise=True, seed=0, feed=None):
    """Run an arm (its readings in the order angle, speed, mid, base) under a controller from rest at angle 0.

    feed (samples,) is added to the commands, and the sum kept to the limit.
    """
    plant = arm.plant(INTERVAL)
    plant.place()
    kernel, d, n, s, w = plant.kernel, plant.constants, plant.layout, plant.state, plant.scratch
    draw = np.random.default_rng(seed)
    sigma = noise * np.array([table["noise"] for table in arm.sensors.values()])
    step = np.array([max(noise * table["resolution"], 1e-12) for table in arm.sensors.values()])
    truth, commands, shown = np.zeros((len(targets), len(sigma))), np.zeros(len(targets)), np.zeros(len(sigma))
    controller.reset()
    waiting = deque([0.0] * plant.delay_samples)
    for k, target in enumerate(targets):
        kernel.measure(d, n, s, shown, 0)
        truth[k] = shown
        readings = np.round((shown + sigma * draw.standard_normal(len(sigma))) / step) * step
        commands[k] = controller.clipped(controller.act(np.append(readings, target)) + (0.0 if feed is None else feed[k]))
        waiting.append(commands[k])
        before = s[layout.COMMAND]
        kernel.control_step(d, n, s, before, kernel.drive_output(d, n, s, waiting.popleft()), w)
    return Run(truth, commands, np.asarray(targets))


def slew(arm, controller, seconds=6.0, noise=True):
    """100 degrees from rest (thesis section 4.5)."""
    return close(arm, controller, np.full(round(seconds / INTERVAL), SLEW), noise)


def frictionless(arm):
    """The arm without any effect: M, K and the drive alone."""
    return replace(arm, effects={})


def loaded(arm, mass):
    """The arm with a payload [kg]."""
    return arm.with_effect("payload", mass=mass) if mass else arm
