"""The three experiments of the practice recordings, varied by a seed."""

from __future__ import annotations

import zlib
from typing import NamedTuple

import numpy as np

PD = (2.5308, 0.6625)  # [A/rad, A s/rad], the thesis's controller
LIMIT = 5.0  # [A], of the command under a controller
PULSES = ((3.0, 0.5, 1.0), (-3.0, 4.0, 4.6), (3.5, 7.0, 7.3))  # [A, s, s]
TONES = (0.4, 0.7, 1.1, 1.7, 2.3, 3.1, 4.3, 5.9, 7.3, 8.9, 10.3, 12.1)  # [Hz]
TONE = 0.55  # [A]
EXPERIMENTS = ("pulse", "square", "sweep")


class Plan(NamedTuple):
    """One experiment: command = feed [A] + P (target [rad] - angle) - D speed, within ± limit [A]."""

    feed: np.ndarray
    target: np.ndarray
    gains: tuple[float, float, float]


def stream(seed: int, *key: str) -> np.random.Generator:
    """Return the random stream of `seed` and `key`: adding a draw elsewhere does not move it."""
    return np.random.default_rng([seed, zlib.crc32("/".join(key).encode())])


def pulse(t: np.ndarray, spread: np.random.Generator | None) -> Plan:
    """Open-loop current pulses; `spread` changes each size by up to 20 % and each time by up to 0.1 s."""
    feed = np.zeros_like(t)
    for size, start, end in PULSES:
        factor, shift, longer = spread.uniform([0.8, -0.1, -0.1], [1.2, 0.1, 0.1]) if spread else (1.0, 0.0, 0.0)
        inside = (t >= start + shift - 1e-9) & (t < end + shift + longer - 1e-9)
        feed[inside] = np.round(size * factor, 2)
    return Plan(feed, np.zeros_like(t), (0.0, 0.0, np.inf))


def square(t: np.ndarray, spread: np.random.Generator | None) -> Plan:
    """PD on a square wave of ±50° at 0.2 Hz; `spread` changes amplitude and period by up to 15 %."""
    size, period = spread.uniform(0.85, 1.15, 2) if spread else (1.0, 1.0)
    sign = np.where(np.floor(t / (2.5 * period) + 1e-9) % 2 == 0, 1.0, -1.0)
    return Plan(np.zeros_like(t), np.deg2rad(50.0) * size * sign, (*PD, LIMIT))


def sweep(t: np.ndarray, spread: np.random.Generator | None, phases: np.random.Generator) -> Plan:
    """PD on a slow sine of 35° at 0.13 Hz, plus tones of 0.55 A with random phases."""
    size, slow = spread.uniform(0.85, 1.15, 2) if spread else (1.0, 1.0)
    phase = phases.uniform(-np.pi, np.pi, len(TONES))
    feed = TONE * sum(np.sin(2 * np.pi * f * t + p) for f, p in zip(TONES, phase, strict=True))
    return Plan(feed, np.deg2rad(35.0) * size * np.sin(2 * np.pi * 0.13 * slow * t), (*PD, LIMIT))


def plan(experiment: str | np.ndarray, t: np.ndarray, seed: int, vary: bool) -> Plan:
    """Return the plan of a named experiment, or of an array of current commands [A] the length of `t` [s]."""
    if not isinstance(experiment, str):
        return Plan(np.asarray(experiment, dtype=float), np.zeros_like(t), (0.0, 0.0, np.inf))
    spread = stream(seed, experiment, "details") if vary else None
    if experiment == "pulse":
        return pulse(t, spread)
    if experiment == "square":
        return square(t, spread)
    if experiment == "sweep":
        return sweep(t, spread, stream(seed, "sweep", "phases"))
    raise ValueError(f"no experiment {experiment!r}: one of {', '.join(EXPERIMENTS)}, or an array of currents [A]")
