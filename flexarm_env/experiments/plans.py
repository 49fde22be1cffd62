"""Plans of experiments: the open-loop part of the command and the angle to follow, for the size of an arm's drive."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.thesis_drive import command_scale

Floats = NDArray[np.float64]

EXPERIMENTS = ("pulse", "square", "sweep")
#: Pulses and tones are those for the thesis's drive. Commands to others are scaled.
FIRST_PULSE = (3.0, 0.5, 1.0)  # [A, s, s], thesis section 3.1
SQUARE_ANGLE, SQUARE_PERIOD = np.deg2rad(50.0), 5.0
SWEEP_ANGLE, SWEEP_FREQUENCY = np.deg2rad(35.0), 0.13
TONES = (0.4, 0.7, 1.1, 1.7, 2.3, 3.1, 4.3, 5.9, 7.3, 8.9, 10.3, 12.1)  # [Hz]
TONE = 0.55  # [A]


@dataclass(frozen=True)
class Plan:
    """An experiment of n samples: command = feed + PD on the reference, where there is one; a position drive takes it as it is.

    Attributes:
        feed: (n,) open-loop part of the command [A or V].
        reference: (n,) angle to follow [rad], or None in open loop.
    """

    feed: Floats
    reference: Floats | None


def random_stream(seed: int, *key: str) -> np.random.Generator:
    """Make a random stream for a seed and a key: a draw elsewhere does not move it."""
    return np.random.default_rng(np.random.SeedSequence([seed, zlib.crc32("/".join(key).encode())]))


def plan_of(arm: Arm, experiment: str, time: Floats, seed: int) -> Plan:
    """Plan an experiment at times (n,) [s].

    Raises:
        InputError: for feedback on an angle that the arm does not measure.
    """
    if experiment != "pulse" and "arm_angle" not in arm.sensors:
        raise InputError(f"input '{experiment}' needs the signal arm_angle, which arm '{arm.name}' does not measure; use pulse")
    scale = command_scale(arm)
    if experiment == "pulse":
        return Plan(scale * _pulses(time, seed), None)
    if experiment == "square":
        half_periods = np.floor(2.0 * time / SQUARE_PERIOD + 1e-9)
        return Plan(np.zeros_like(time), SQUARE_ANGLE * np.where(half_periods % 2 == 0, 1.0, -1.0))
    phases = random_stream(seed, "sweep", "phases").uniform(-np.pi, np.pi, len(TONES))
    tones = np.sin(2.0 * np.pi * np.outer(time, TONES) + phases)
    return Plan(scale * TONE * tones.sum(axis=1), SWEEP_ANGLE * np.sin(2.0 * np.pi * SWEEP_FREQUENCY * time))


def _pulses(time: Floats, seed: int) -> Floats:
    """Draw pulses of alternating sign [A], about one every three seconds."""
    draw = random_stream(seed, "pulse", "sizes")
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
