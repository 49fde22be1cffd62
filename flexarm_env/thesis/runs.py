"""Runs of an arm under a current or a controller, sample by sample, on the product's plant."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.controllers import Controller
from flexarm_env.plant import layout

Floats = NDArray[np.float64]

#: Interval of sampling and control [s]. The thesis's simulated controllers act at each of its steps; 1 ms is 1/20 of the
#: shortest vibration's period, and its rig was sampled more slowly.
INTERVAL = 0.001
DURATION = 5.0
PULSE = 3.0  # [A], thesis sections 3.4 and 4


@dataclass(frozen=True, eq=False)
class Run:
    """Samples of one run.

    Attributes:
        time: (samples,) [s].
        command: (samples,) [A], held from each sample to the next.
        signals: true readings by name, each (samples,) [rad, rad/s, V].
        stuck: (samples,) whether friction holds the hub.
        target: (samples,) [rad].
    """

    time: Floats
    command: Floats
    signals: Mapping[str, Floats]
    stuck: NDArray[np.bool_]
    target: Floats

    @property
    def angle(self) -> Floats:
        """Hub angle (samples,) [deg]."""
        return np.rad2deg(self.signals["arm_angle"])

    @property
    def speed(self) -> Floats:
        """Motor speed (samples,) [rad/s]."""
        return self.signals["motor_speed"]

    @property
    def strain(self) -> Floats:
        """Reading of the gage at mid-beam (samples,) [V]."""
        return self.signals["strain_mid"]

    def between(self, start: float, stop: float) -> slice:
        """Select the samples from start to stop [s]."""
        low, high = np.searchsorted(self.time, [start - 1e-9, stop - 1e-9])
        return slice(int(low), int(high))

    def rest(self) -> float:
        """Time of the hub's final stop [s]; infinite if it moves at the end."""
        moving = np.flatnonzero(~self.stuck)
        if not len(moving) or moving[-1] + 1 == len(self.time):
            return 0.0 if not len(moving) else float("inf")
        return float(self.time[moving[-1] + 1])

    def rms(self, start: float, stop: float) -> float:
        """Compute the rms [V] of the strain at mid-beam about its mean, between two times."""
        return float(np.std(self.strain[self.between(start, stop)]))


def clock(count: int, interval: float = INTERVAL) -> Floats:
    """Compute the times of samples (count,) [s]."""
    return np.asarray(np.arange(count) * interval, dtype=np.float64)


def pulse(start: float, duration: float = DURATION, interval: float = INTERVAL) -> Floats:
    """Build a pulse of current (samples,) [A]: 3 A over 0.5 s from `start` [s] on."""
    time = clock(round(duration / interval), interval)
    return np.where((time >= start - 1e-9) & (time < start + 0.5 - 1e-9), PULSE, 0.0)


def square_wave(duration: float, interval: float = INTERVAL) -> Floats:
    """Build a target (samples,) [rad] of ±50° at 0.2 Hz (thesis section 2.3)."""
    half_periods = np.floor(clock(round(duration / interval), interval) / 2.5 + 1e-9)
    return np.deg2rad(50.0) * np.where(half_periods % 2 == 0, 1.0, -1.0)


def run(
    arm: Arm,
    controller: Controller | None = None,
    *,
    target: Floats | None = None,
    feed: Floats | None = None,
    interval: float = INTERVAL,
    noise: int | None = None,
    start: Floats | None = None,
) -> Run:
    """Run an arm from rest at angle 0, under a controller or a current alone.

    Args:
        arm: with its limit of current, which applies to the sum of controller and feed.
        controller: acts on the readings; None for none.
        target: (samples,) angle to reach [rad].
        feed: (samples,) added current [A].
        interval: of sampling and control [s].
        noise: seed of the sensors' noise, which comes with their resolution; None for true readings.
        start: initial physical state (states,), by default at rest.
    """
    count = len(target) if target is not None else len(feed if feed is not None else ())
    target, feed = (np.zeros(count) if part is None else part for part in (target, feed))
    plant = arm.plant(interval)
    plant.place(start)
    kernel, d, n, s, w = plant.kernel, plant.constants, plant.layout, plant.state, plant.scratch
    shown = _Sensors(arm, count, noise)
    limit = arm.constants["drive"]["limit"] or np.inf
    truth, command, stuck = np.zeros((count, len(arm.signals))), np.zeros(count), np.zeros(count, dtype=bool)
    waiting = deque([0.0] * plant.delay_samples)
    if controller is not None:
        controller.reset()
    for k in range(count):
        kernel.measure(d, n, s, truth[k], 0)
        stuck[k] = int(s[layout.MODE]) & 1
        wanted = feed[k]
        if controller is not None:
            wanted += float(controller.act(np.append(shown.of(truth[k], k), target[k])))
        command[k] = min(max(wanted, -limit), limit)
        waiting.append(command[k])
        before = s[layout.COMMAND]
        kernel.control_step(d, n, s, before, kernel.let_through(d, n, s, waiting.popleft()), w)
        if not abs(truth[k, 1]) < RUN_AWAY:
            truth, command, stuck, target = truth[:k], command[:k], stuck[:k], target[:k]
            break
    signals = {signal: truth[:, i] for i, signal in enumerate(arm.signals)}
    return Run(clock(len(truth), interval), command, signals, stuck, target)


#: Motor speed [rad/s] at which a diverging run is ended: a hundred times the motor's largest.
RUN_AWAY = 4e4


class _Sensors:
    """Readings for a controller: with noise and resolution, or exact."""

    def __init__(self, arm: Arm, count: int, seed: int | None) -> None:
        tables = list(arm.sensors.values())
        self.step = np.array([table["resolution"] for table in tables])
        self.noise: Floats | None = None
        if seed is not None:
            draw = np.random.default_rng(seed).standard_normal((count, len(tables)))
            self.noise = draw * np.array([table["noise"] for table in tables])

    def of(self, truth: Floats, k: int) -> Floats:
        if self.noise is None:
            return truth
        noisy = truth + self.noise[k]
        coarse = np.where(self.step > 0.0, self.step, 1.0)
        return np.where(self.step > 0.0, np.round(noisy / coarse) * coarse, noisy)
