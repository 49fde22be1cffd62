"""Recordings made by an arm's model: the experiments of a laboratory, with the noise of its sensors."""

from __future__ import annotations

import os
import zlib
from collections import deque
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.experiments.payload import check_payload, stated_payload, with_payload
from flexarm_env.plant import layout
from flexarm_env.recordings.recording import Recording
from flexarm_env.thesis_drive import DERIVATIVE, GEAR_RATIO, PROPORTIONAL, command_scale

Floats = NDArray[np.float64]

EXPERIMENTS = ("pulse", "square", "sweep")
#: Pulses and tones are those for the thesis's drive; commands to others are scaled.
FIRST_PULSE = (3.0, 0.5, 1.0)  # [A, s, s], thesis section 3.1
SQUARE_ANGLE, SQUARE_PERIOD = np.deg2rad(50.0), 5.0
SWEEP_ANGLE, SWEEP_FREQUENCY = np.deg2rad(35.0), 0.13
TONES = (0.4, 0.7, 1.1, 1.7, 2.3, 3.1, 4.3, 5.9, 7.3, 8.9, 10.3, 12.1)  # [Hz]
TONE = 0.55  # [A]
#: Time constant [s] of the speed that is taken from the angle where no sensor gives it.
SPEED_FILTER = 0.02
MOST_SAMPLES = 10_000_000


@dataclass(frozen=True)
class Plan:
    """An experiment of n samples: command = feed + PD on the reference, where there is one.

    Attributes:
        feed: (n,) open-loop part of the command [A or V].
        reference: (n,) angle to follow [rad], or None in open loop.
    """

    feed: Floats
    reference: Floats | None


def simulate(
    arm: Arm,
    input: str | os.PathLike[str] | Recording = "pulse",
    duration: float = 10.0,
    rate: float = 500.0,
    seed: int = 0,
    noise: bool = True,
    name: str | None = None,
) -> Recording:
    """Return a recording of the arm, from rest at angle 0. The same arguments give the same bits.

    Args:
        arm: with its sensors' noise, steps and dead times.
        input: "pulse" (open loop: 3 A from 0.5 to 1.0 s, then pulses of random size and time), "square" (PD to ±50° at
            0.2 Hz), "sweep" (slow PD motion and tones of random phase in the command), or a recording, or the path of
            one, whose commands are played, with its payload; it needs no signals. Sizes are for a drive of 5 A and
            scale with the arm's limit.
        duration: [s]; a recording brings its own.
        rate: samples per second [Hz]; a recording brings its own.
        seed: of noise, pulses and phases.
        noise: whether readings get noise and the sensor's steps.
        name: of the recording; that of the input by default.

    Raises:
        InputError: for an input that does not exist or does not fit the arm.
    """
    conditions: dict[str, float] = {}
    if isinstance(input, str) and input in EXPERIMENTS:
        count = _samples(duration, rate)
        rig = _Rig(arm, rate, count, _noise(arm, count, seed, input) if noise else None)
        time = np.arange(count) / rate
        plan = _plan(arm, input, np.arange(len(rig.readings)) / rate, seed)
        commands, readings = rig.run(plan)
        reference = None if plan.reference is None else plan.reference[:count]
        label = input
    else:
        source = input if isinstance(input, Recording) else _read(input)
        if source.input_kind != arm.input:
            raise InputError(f"{source.name}: holds {source.input_kind}, but arm '{arm.name}' is driven by {arm.input}")
        time, commands, reference, label = source.time, source.command, source.reference, source.name
        draws = _noise(arm, len(time), seed, label) if noise else None
        even, interval = _sampling(time)
        conditions = {key: value for key, value in source.conditions.items() if key == "payload"}
        check_payload(arm, source)
        carrying = with_payload(arm, stated_payload(source))
        readings = _Rig(carrying, 1.0 / interval, len(time), draws).replay(commands, () if even else (np.diff(time),))
    signals = {signal: readings[:, i] for i, signal in enumerate(arm.signals)}
    return Recording.from_arrays(name or label, time, arm.input, commands, signals, reference, conditions)


def _samples(duration: float, rate: float) -> int:
    if not (np.isfinite(duration) and np.isfinite(rate) and duration > 0.0 and rate > 0.0):
        raise InputError(f"duration {duration:g} s at {rate:g} Hz; give two positive numbers")
    count = duration * rate
    if not 1.5 <= count <= MOST_SAMPLES:
        raise InputError(f"{duration:g} s at {rate:g} Hz make {count:.3g} samples; allowed are 2 to {MOST_SAMPLES}")
    return round(count)


def _sampling(time: Floats) -> tuple[bool, float]:
    """Whether samples are even, and the interval [s], free of the rounding of the times."""
    steps = np.diff(time)
    median = float(np.median(steps))
    even = bool(np.abs(steps - median).max() <= 1e-6 * median)
    return even, float(f"{time[-1] / len(steps) if even else median:.12g}")


def _read(path: str | os.PathLike[str]) -> Recording:
    if isinstance(path, str) and not Path(path).exists() and not Path(path).suffix:
        raise InputError(f"no input '{path}': neither an experiment nor a file{did_you_mean(path, EXPERIMENTS)}")
    return Recording.read(path, measured=False)


def _stream(seed: int, *key: str) -> np.random.Generator:
    """A random stream for a seed and a key: a draw elsewhere does not move it."""
    return np.random.default_rng(np.random.SeedSequence([seed, zlib.crc32("/".join(key).encode())]))


def _noise(arm: Arm, count: int, seed: int, experiment: str) -> Floats:
    """Noise of every sensor (count, signals)."""
    draws = [_stream(seed, experiment, signal).standard_normal(count) * s["noise"] for signal, s in arm.sensors.items()]
    return np.column_stack(draws) if draws else np.zeros((count, 0))


def _plan(arm: Arm, experiment: str, time: Floats, seed: int) -> Plan:
    if experiment != "pulse" and "arm_angle" not in arm.sensors:
        raise InputError(f"input '{experiment}' needs the signal arm_angle, which arm '{arm.name}' does not measure; use pulse")
    scale = command_scale(arm)
    if experiment == "pulse":
        return Plan(scale * _pulses(time, seed), None)
    if experiment == "square":
        half_periods = np.floor(2.0 * time / SQUARE_PERIOD + 1e-9)
        return Plan(np.zeros_like(time), SQUARE_ANGLE * np.where(half_periods % 2 == 0, 1.0, -1.0))
    phases = _stream(seed, "sweep", "phases").uniform(-np.pi, np.pi, len(TONES))
    tones = np.sin(2.0 * np.pi * np.outer(time, TONES) + phases)
    return Plan(scale * TONE * tones.sum(axis=1), SWEEP_ANGLE * np.sin(2.0 * np.pi * SWEEP_FREQUENCY * time))


def _pulses(time: Floats, seed: int) -> Floats:
    """Pulses of alternating sign [A], about one every three seconds."""
    draw = _stream(seed, "pulse", "sizes")
    feed = np.zeros_like(time)
    size, start, end = FIRST_PULSE
    sign = 1.0
    while start < time[-1]:
        feed[(time >= start - 1e-9) & (time < end - 1e-9)] = sign * size
        sign = -sign
        size = round(draw.uniform(2.4, 3.6), 2)
        start = round(end + draw.uniform(2.2, 3.0), 3)
        end = round(start + draw.uniform(0.25, 0.5), 3)
    return feed


class _Rig:
    """A plant that is played sample by sample, and its sensors with dead time, noise and steps."""

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
        self.speed = _Speed(arm, rate)
        self.limit = arm.constants["drive"]["limit"]
        scale, gears = command_scale(arm), GEAR_RATIO / arm.constants["drive"]["gear_ratio"]
        self.gains = (scale * PROPORTIONAL, scale * gears * DERIVATIVE)

    def run(self, plan: Plan) -> tuple[Floats, Floats]:
        """Play a plan; return commands (count,) and readings (count, signals)."""
        kernel, plant = self.plant.kernel, self.plant
        d, n, s, scratch = plant.constants, plant.layout, plant.state, plant.scratch
        waiting = deque([0.0] * max(plant.delay_samples, 0))
        truth, width = self.truth.reshape(-1), len(self.columns)
        commands = np.zeros(len(self.truth))
        for k in range(len(commands)):
            kernel.measure(d, n, s, truth, k * width)
            self.readings[k] = self._shown(k)
            # Readings from before the first command can only be had if that command comes late.
            commands[k] = self._command(plan, k) if k >= self.ahead else 0.0
            waiting.append(commands[k])
            before = s[layout.COMMAND]
            command = kernel.drive_output(d, n, s, waiting.popleft())
            kernel.control_step(d, n, s, before, command, scratch)
        return commands[: self.count], self.readings[self.ahead :]

    def replay(self, commands: Floats, intervals: tuple[Floats, ...]) -> Floats:
        """Play commands (count,), at uneven intervals [s] if they are given; return readings (count, signals)."""
        first = self.ahead
        played = self.plant.replay(np.ascontiguousarray(commands), *intervals)
        self.truth[first:], self.truth[:first] = played, played[0]
        return self._shown(slice(first, None))

    def _shown(self, k: int | slice) -> Floats:
        """What the sensors show at sample k: a little late, with noise, in steps."""
        before = self.truth[self.before[k], self.columns]
        quantity = before + self.share[k] * (self.truth[self.after[k], self.columns] - before)
        shown = quantity + self.noise[k]
        coarse = self.steps > 0.0
        shown[..., coarse] = np.round(shown[..., coarse] / self.steps[coarse]) * self.steps[coarse] + 0.0
        return shown

    def _command(self, plan: Plan, k: int) -> float:
        command = float(plan.feed[k])
        if plan.reference is not None:
            angle, speed = self.speed.read(self.readings[k])
            command += self.gains[0] * (float(plan.reference[k]) - angle) - self.gains[1] * speed
        return min(max(command, -self.limit), self.limit) if self.limit > 0.0 else command


class _Speed:
    """The angle of the arm and the speed of the motor as a controller knows them."""

    def __init__(self, arm: Arm, rate: float) -> None:
        signals = list(arm.signals)
        self.angle = signals.index("arm_angle") if "arm_angle" in signals else -1
        self.tach = signals.index("motor_speed") if "motor_speed" in signals else -1
        self.rate, self.gear_ratio = rate, arm.constants["drive"]["gear_ratio"]
        self.last: float | None = None
        self.speed = 0.0

    def read(self, readings: Floats) -> tuple[float, float]:
        """Return angle [rad] and motor speed [rad/s], this one from the angle where there is no tachometer."""
        angle = float(readings[self.angle])
        if self.tach >= 0:
            return angle, float(readings[self.tach])
        slope = 0.0 if self.last is None else (angle - self.last) * self.rate * self.gear_ratio
        self.last = angle
        self.speed += (slope - self.speed) / (1.0 + SPEED_FILTER * self.rate)
        return angle, self.speed
