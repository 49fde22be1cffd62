"""Recordings whose faults are mended in memory, as the lines of the column map would on reading."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.series import Floats
from flexarm_env.recordings.recording import Recording
from flexarm_env.recordings.resolution import repeated_readings


def mended(recording: Recording, faults: Iterable[Fault]) -> Recording:
    """Mend faults.

    Wraps are undone, readings that are none become NaN, signals that never move are dropped, commands end at the limit, and of
    glued runs the first is kept.
    """
    signals, command, end = dict(recording.signals), recording.command, None
    for one in faults:
        if one.kind == "glued" and end is None:
            end = one.value
        if one.kind == "limit" and one.value is not None:
            largest = float(np.abs(command).max()) / one.value
            command = np.clip(command, -largest, largest)
        if one.signal not in signals:
            continue
        if one.kind == "constant":
            del signals[one.signal]
        elif one.kind == "wrap" and one.value is not None:
            signals[one.signal] = unwrapped(signals[one.signal], np.array(one.rows), one.value)
        elif one.kind in ("spike", "dropout", "rail"):
            signals[one.signal] = without(signals[one.signal], np.array(one.rows))
        elif one.kind == "held" and one.value is not None:
            values = signals[one.signal]
            signals[one.signal] = without(values, np.flatnonzero(repeated_readings(values, round(one.value))))
    left = replace(recording, signals=signals, command=command)
    return left if end is None else left.part(0.0, end)


def unwrapped(values: Floats, rows: np.ndarray, modulus: float) -> Floats:
    """Undo the jumps at some samples.

    Args:
        values: (n,) readings.
        rows: samples right after a jump.
        modulus: step of the wrap.
    """
    before = np.array([values[:row][np.isfinite(values[:row])][-1] for row in rows])
    turns = np.zeros(len(values))
    turns[rows] = -np.sign(values[rows] - before)
    return values + modulus * np.cumsum(turns)


def without(values: Floats, rows: np.ndarray) -> Floats:
    """Replace the readings at some samples by NaN."""
    left = values.copy()
    left[rows] = np.nan
    return left
