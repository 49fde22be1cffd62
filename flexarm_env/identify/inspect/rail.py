"""Readings that stand at the end of the sensor's or the amplifier's range."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.rail_evidence import stands_at
from flexarm_env.identify.inspect.report import fault
from flexarm_env.identify.inspect.series import Inspected, Series
from flexarm_env.identify.percent import percent
from flexarm_env.identify.settings import Inspecting
from flexarm_env.recordings.columns import UNITS


def rail(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find signals that stand at their largest or smallest reading as no noisy and no moving signal does."""
    recording = inspected.recording
    found = []
    series = {signal: inspected.series(signal, numbers) for signal in recording.signals}
    for signal, one in series.items():
        ends = [end for end in (-1, 1) if stands_at(end, signal, series, numbers)]
        if not ends:
            continue
        levels = _levels(one, ends, numbers)
        at_level = np.isin(one.values, levels)
        value = max(levels, key=abs)
        both = len(levels) == 2 and math.isclose(*np.abs(levels), rel_tol=numbers.same_jump)
        ends_text = f"±{abs(value):.5g}" if both else " and ".join(f"{level:.5g}" for level in levels)
        unit = UNITS[signal]
        text = (
            f"stands at its extreme of {ends_text} {unit} in {percent(float(at_level.mean()))} of the rows: it is cut off there"
        )
        low, high = _range(one, levels)
        hint = f'{signal} = {{ range = ["{_text(low, 1)} {unit}", "{_text(high, -1)} {unit}"] }}'
        found.append(fault(recording, signal, "rail", abs(value) if both else value, text, hint, one.rows[at_level]))
    return found


def _levels(series: Series, ends: list[int], numbers: Inspecting) -> list[float]:
    """List the readings at the ends; the other end, too, where its reading lies exactly as far from 0."""
    both = [float(series.values.min()), float(series.values.max())]
    if math.isclose(both[0], -both[1], rel_tol=numbers.rounding):
        return both
    return [both[end > 0] for end in ends]


def _range(series: Series, levels: list[float]) -> tuple[float, float]:
    """Choose a range that ends at the levels; an end that the readings do not reach lies as far out as they extend."""
    low, high = float(series.values.min()), float(series.values.max())
    extent = high - low
    return (low if low in levels else low - extent), (high if high in levels else high + extent)


def _text(end: float, inward: int) -> str:
    """Format an end of a range so that its rounding (inward: 1 up, -1 down) does not leave the readings at it inside."""
    text = f"{end:.6g}"
    return text if inward * float(text) >= inward * end else repr(end)
