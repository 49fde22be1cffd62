"""The experiments of a machine: pulses in open loop, and square waves and sines under a controller."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.machines.model import Model, Rng
from tests.rig import Plan

Floats = NDArray[np.float64]

#: Tones on top of a slow sine: how many, between which frequencies [Hz], and their sum's rms over the largest command.
TONES, LOWEST, HIGHEST, LOUDNESS = 10, 0.4, 12.0, 0.12
#: Samples per second [Hz], whose time holds a whole number of the rig's steps.
RATES = (100.0, 125.0, 200.0, 250.0, 500.0, 625.0, 1000.0)
#: Damping ratio of the control loop.
DAMPING = 0.8


@dataclass(frozen=True)
class Run:
    """One recording to make.

    Attributes:
        name: of the recording.
        plan: for the rig.
        rate: samples per second [Hz].
        seed: of its noise.
    """

    name: str
    plan: Plan
    rate: float
    seed: int


def runs(draw: Rng, model: Model) -> tuple[Run, ...]:
    """Draw one to three experiments of 5 to 10 s."""
    kinds = draw.permutation(list(EXPERIMENTS))[: draw.integers(1, 4)]
    rate, duration = float(draw.choice(RATES)), float(draw.uniform(5.0, 10.0))
    time = np.arange(round(duration * rate)) / rate
    return tuple(Run(str(kind), EXPERIMENTS[kind](draw, model, time), rate, int(draw.integers(2**31))) for kind in kinds)


def gains(model: Model) -> tuple[float, float, float]:
    """Compute a controller: command per angle of the hub, per speed of the motor, and largest command.

    Under a voltage the motor's own damping makes up for a part of the second.
    """
    drive = model.values
    per_angle = model.inertia * model.bandwidth**2
    per_speed = 2.0 * DAMPING * model.inertia * model.bandwidth
    if model.arm.input == "voltage":
        own = (drive["drive.gear_ratio"] * drive["drive.torque_constant"]) ** 2 / drive["drive.resistance"]
        per_speed = max(per_speed - own, 0.0)
    unit = model.torque_per_command
    return per_angle / unit, per_speed / unit / drive["drive.gear_ratio"], drive["drive.limit"]


def pulses(draw: Rng, model: Model, time: Floats) -> Plan:
    """Plan pulses that set the axis in motion and stop it again, by turns either way.

    Where no friction would hold it then, or its weight would turn it, a controller holds it at angle 0 meanwhile.
    """
    feed = np.zeros_like(time)
    limit, start, sign = model.values["drive.limit"], float(draw.uniform(0.3, 0.8)), 1.0
    while start < time[-1]:
        share, coast = float(draw.uniform(0.4, 0.9)), float(draw.uniform(0.2, 0.5))
        push = math.sqrt(model.angle * model.inertia / (share * model.torque) * draw.uniform(0.5, 1.0))
        for begin, size in ((start, share), (start + push + coast, -share)):
            feed[(time >= begin) & (time < begin + push)] = round(sign * size * limit, 6)
        start, sign = start + 2.0 * push + coast + float(draw.uniform(0.4, 1.2)), -sign
    loose = "effects.coulomb.torque" not in model.values or "effects.base_tilt.torque" in model.values
    return Plan(feed, np.zeros_like(time), gains(model) if loose else (0.0, 0.0, math.inf))


def square(draw: Rng, model: Model, time: Floats) -> Plan:
    """Plan a square wave of the angle."""
    half = max(time[-1] / draw.uniform(3.0, 6.0), 0.8)
    sign = np.where(np.floor(time / half + 1e-9) % 2 == 0, 1.0, -1.0)
    return Plan(np.zeros_like(time), float(draw.uniform(0.7, 1.0)) * model.angle * sign, gains(model))


def sweep(draw: Rng, model: Model, time: Floats) -> Plan:
    """Plan a slow sine of the angle, with tones of random phase in the command."""
    limit, rate = model.values["drive.limit"], 1.0 / (time[1] - time[0])
    frequencies = np.geomspace(LOWEST, min(HIGHEST, 0.2 * rate), TONES)
    phases = draw.uniform(-np.pi, np.pi, TONES)
    tones = np.sin(2.0 * np.pi * np.outer(time, frequencies) + phases).sum(axis=1)
    slow = float(draw.uniform(0.15, 0.3))
    target = model.angle * np.sin(2.0 * np.pi * slow * time)
    return Plan(LOUDNESS * limit * tones / math.sqrt(TONES / 2.0), target, gains(model))


EXPERIMENTS: dict[str, Callable[[Rng, Model, Floats], Plan]] = {"pulses": pulses, "square": square, "sweep": sweep}
