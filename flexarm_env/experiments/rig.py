"""A simulated rig: an arm's plant and its sensors, run sample by sample under feedback or with given commands."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.plans import Plan
from flexarm_env.plant import layout
from flexarm_env.plant.tangents.tangents import Tangents
from flexarm_env.thesis_drive import DERIVATIVE, GEAR_RATIO, PROPORTIONAL, command_scale

Floats = NDArray[np.float64]

#: Time constant [s] of the speed that is taken from the angle where no sensor gives it.
SPEED_FILTER = 0.02


class Rig:
    """A plant and its sensors with dead time, noise and steps.

    Args:
        arm: that is simulated, from rest at angle 0.
        rate: samples per second [Hz].
        count: samples.
        noise: (count, signals) added to the readings; None leaves out the sensors' steps, too.
    """

    def __init__(self, arm: Arm, rate: float, count: int, noise: Floats | None) -> None:
        self.plant = arm.plant(1.0 / rate)
        self.plant.place()
        sensors = list(arm.sensors.values())
        self.count = count
        #: Samples by which the readings' clock is ahead of the commands'.
        self.ahead = max(-self.plant.delay_samples, 0)
        total = count + self.ahead
        self.truth = np.zeros((total, len(sensors)))
        self.readings = np.zeros_like(self.truth)
        self.noise = np.zeros_like(self.truth)
        self.steps = np.zeros(len(sensors))
        if noise is not None:
            self.noise[self.ahead :] = noise
            self.steps = np.array([s["resolution"] for s in sensors])
        late = np.outer(np.arange(total), np.ones(len(sensors))) - np.array([s["delay"] * rate for s in sensors])
        self.before = np.maximum(np.floor(late), 0.0).astype(int)
        self.after = np.maximum(np.ceil(late), 0.0).astype(int)
        self.share = late - np.floor(late)
        self.columns = np.arange(len(sensors))
        self.speed = SpeedEstimate(arm, rate)
        #: Whether the drive follows an angle by itself.
        self.follows = arm.input == "position"
        self.limit = arm.constants["drive"]["limit"]
        scale, gears = command_scale(arm), GEAR_RATIO / arm.constants["drive"]["gear_ratio"]
        self.gains = (scale * PROPORTIONAL, scale * gears * DERIVATIVE)

    def run(self, plan: Plan) -> tuple[Floats, Floats]:
        """Run a plan under feedback; return commands (count,) and readings (count, signals)."""
        kernel, plant = self.plant.kernel, self.plant
        d, n, s, scratch = plant.constants, plant.layout, plant.state, plant.scratch
        waiting = deque([0.0] * max(plant.delay_samples, 0))
        truth, width = self.truth.reshape(-1), len(self.columns)
        commands = np.zeros(len(self.truth))
        for k in range(len(commands)):
            kernel.measure(d, n, s, truth, k * width)
            self.readings[k] = self._sensor_output(k)
            # Readings from before the first command can only be had if that command comes late.
            commands[k] = self._command(plan, k) if k >= self.ahead else 0.0
            waiting.append(commands[k])
            before = s[layout.COMMAND]
            command = kernel.drive_output(d, n, s, waiting.popleft())
            kernel.control_step(d, n, s, before, command, scratch)
        return commands[: self.count], self.readings[self.ahead :]

    def replay(self, commands: Floats, intervals: tuple[Floats, ...]) -> Floats:
        """Apply commands (count,), at uneven intervals [s] if they are given; return readings (count, signals)."""
        first = self.ahead
        played = self.plant.replay(np.ascontiguousarray(commands), *intervals)
        self.truth[first:], self.truth[:first] = played, played[0]
        return self._sensor_output(slice(first, None))

    def replay_derivatives(self, commands: Floats, intervals: tuple[Floats, ...], tangents: Tangents) -> Floats:
        """Replay commands, and return the derivatives of the readings without noise and steps (count, signals, constants)."""
        first, derivatives = self.ahead, np.zeros((*self.truth.shape, tangents.count))
        self.truth[first:], derivatives[first:] = tangents.replay(np.ascontiguousarray(commands), *intervals)
        derivatives[:first] = derivatives[first]
        before, after = (derivatives[rows[first:], self.columns] for rows in (self.before, self.after))
        return before + self.share[first:, :, None] * (after - before)

    def _sensor_output(self, k: int | slice) -> Floats:
        """Compute the readings at sample k from the truth: late by the dead time, with noise, in steps."""
        before = self.truth[self.before[k], self.columns]
        quantity = before + self.share[k] * (self.truth[self.after[k], self.columns] - before)
        output = quantity + self.noise[k]
        coarse = self.steps > 0.0
        output[..., coarse] = np.round(output[..., coarse] / self.steps[coarse]) * self.steps[coarse] + 0.0
        return output

    def _command(self, plan: Plan, k: int) -> float:
        command = float(plan.feed[k])
        if plan.reference is not None and self.follows:
            command += float(plan.reference[k])
        elif plan.reference is not None:
            angle, speed = self.speed.read(self.readings[k])
            command += self.gains[0] * (float(plan.reference[k]) - angle) - self.gains[1] * speed
        return min(max(command, -self.limit), self.limit) if self.limit > 0.0 else command


class SpeedEstimate:
    """Angle of the arm and speed of the motor for the feedback, from the sensors that there are."""

    def __init__(self, arm: Arm, rate: float) -> None:
        signals = list(arm.signals)
        self.angle = signals.index("arm_angle") if "arm_angle" in signals else -1
        self.tach = signals.index("motor_speed") if "motor_speed" in signals else -1
        self.rate, self.gear_ratio = rate, arm.constants["drive"]["gear_ratio"]
        self.last: float | None = None
        self.speed = 0.0

    def read(self, readings: Floats) -> tuple[float, float]:
        """Read angle [rad] and motor speed [rad/s]; without a tachometer the filtered slope of the angle."""
        angle = float(readings[self.angle])
        if self.tach >= 0:
            return angle, float(readings[self.tach])
        slope = 0.0 if self.last is None else (angle - self.last) * self.rate * self.gear_ratio
        self.last = angle
        self.speed += (slope - self.speed) / (1.0 + SPEED_FILTER * self.rate)
        return angle, self.speed
