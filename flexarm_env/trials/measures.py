"""Measures of an episode: settling time, overshoot, steady error, residual vibration, effort."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.tasks import Task

Floats = NDArray[np.float64]

#: Distance from the target within which the tip has settled [rad].
BAND = np.deg2rad(1.0)
#: Time at the end of each stretch over which error and vibration are taken [s].
TAIL = 0.5
#: Name, unit and meaning of each measure; less is better.
MEASURES = {
    "settling_time": ("s", "until the tip stays within ±1° of the target; the whole stretch where it never does"),
    "unsettled": ("%", "stretches at whose end the tip is not within ±1°"),
    "overshoot": ("deg", "furthest that the tip goes beyond the target"),
    "steady_error": ("deg", "mean distance of the tip from the target over the last 0.5 s"),
    "residual_strain": ("V", "rms of the base strain over the last 0.5 s, without the sensor's noise"),
    "peak_current": ("A", "largest command"),
    "energy": ("A² s", "integral of the squared command; times the resistance it is the heat in the motor"),
}


@dataclass(frozen=True)
class Trajectories:
    """Trajectories of arms in one episode each, (samples, arms) unless stated otherwise.

    Attributes:
        tip: angle of the tip seen from the hub's axis [rad].
        target: [rad].
        strain: base strain without noise [V].
        command: [A or V].
        failed: (arms,) whether the episode ended early.
        start: (arms,) hub angle at the start [rad].
        interval: sampling time [s].
    """

    tip: Floats
    target: Floats
    strain: Floats
    command: Floats
    failed: NDArray[np.bool_]
    start: Floats
    interval: float


def measure(seen: Trajectories, task: Task) -> dict[str, Floats]:
    """Compute each measure (arms,), averaged over the stretches between jumps of the target.

    An arm with an early end of its episode counts as never settled, with the errors of the task's whole range.
    """
    length = round((task.half_period or task.duration) / seen.interval)
    firsts = range(0, len(seen.tip) - length + 1, length)
    before = [seen.start, *(seen.target[first - 1] for first in firsts[1:])]
    parts = [_stretch(seen, slice(first, first + length), origin) for first, origin in zip(firsts, before, strict=True)]
    found = {name: np.mean([part[name] for part in parts], axis=0) for name in parts[0]}
    found["peak_current"] = np.abs(seen.command).max(axis=0)
    found["energy"] = np.sum(seen.command**2, axis=0) * seen.interval
    worst = {"settling_time": length * seen.interval, "unsettled": 100.0, "overshoot": 180.0, "steady_error": 180.0}
    for name, value in worst.items():
        found[name] = np.where(seen.failed, value, found[name])
    return {name: found[name] for name in MEASURES}


def _stretch(seen: Trajectories, part: slice, origin: Floats) -> dict[str, Floats]:
    error = seen.tip[part] - seen.target[part]
    tail = max(round(TAIL / seen.interval), 1)
    inside = np.abs(error) <= BAND
    outside_last = len(inside) - np.argmax(~inside[::-1], axis=0)
    settled = np.where(inside.all(axis=0), 0, outside_last)
    direction = np.sign(seen.target[part][0] - origin)
    beyond = np.where(direction == 0.0, np.abs(error), error * direction)
    return {
        "settling_time": settled * seen.interval,
        "unsettled": 100.0 * (settled >= len(inside)),
        "overshoot": np.rad2deg(np.maximum(beyond.max(axis=0), 0.0)),
        "steady_error": np.rad2deg(np.abs(error[-tail:]).mean(axis=0)),
        "residual_strain": np.sqrt(np.mean(seen.strain[part][-tail:] ** 2, axis=0)),
    }
