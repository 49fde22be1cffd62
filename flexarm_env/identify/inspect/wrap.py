"""A reading that leaves its range at one end and returns at the other: an angle within ±π, a counter that overflows."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, shown
from flexarm_env.identify.inspect.series import Floats, Inspected, Integers, Series
from flexarm_env.identify.settings import Inspecting
from flexarm_env.recordings.columns import UNITS

_TURN = 2 * math.pi
#: Moduli of angles in degrees and of counters.
_USUAL = (math.degrees(_TURN), *(2.0**bits for bits in (8, 10, 12, 14, 16, 20, 24, 32)))


def wrap(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find signals that jump by their whole range, and by the same at each jump."""
    recording = inspected.recording
    found = []
    for signal in recording.signals:
        series = inspected.series(signal, numbers)
        steps, modulus = wraps(series, UNITS[signal] == "rad", numbers)
        if modulus:
            times = "once" if len(steps) == 1 else f"{len(steps)} times"
            text = f"jumps by {shown(signal, modulus)} {times}, its whole range: it wraps"
            hint = f'{signal} = {{ wrap = "{modulus:.8g} {UNITS[signal]}" }}'
            found.append(fault(recording, signal, "wrap", modulus, text, hint, series.rows[steps + 1]))
    return found


def wraps(series: Series, is_angle: bool, numbers: Inspecting) -> tuple[Integers, float]:
    """Find the readings after which a signal wraps, and its modulus; 0 where it does not.

    Args:
        series: of the signal.
        is_angle: whether a jump by a whole turn needs no further proof.
        numbers: of the inspection.
    """
    changes, none = series.changes, np.zeros(0, dtype=np.int64)
    extent = float(np.ptp(series.values)) if len(series) else 0.0
    steps = np.flatnonzero(np.abs(changes) > numbers.of_range * extent)
    if not steps.size or len(steps) > numbers.most_wrapping * len(changes):
        return none, 0.0
    jumps = np.abs(changes[steps] - _slopes(changes, steps))
    modulus = float(np.median(jumps))
    others = np.abs(np.delete(changes, steps))
    usual, fast = (float(np.quantile(others, q)) if others.size else 0.0 for q in (numbers.usual, numbers.seldom))
    slack = max(numbers.same_jump * modulus, 2 * usual)
    if (
        not _are_alike(np.abs(jumps - modulus), slack, others, numbers)
        or extent > modulus + slack
        or fast > numbers.smooth * modulus
    ):
        return none, 0.0
    modulus = max(modulus, extent)  # all readings lie within it
    is_turn = is_angle and abs(modulus - _TURN) < max(numbers.same_turn * _TURN, 2 * usual)
    if is_turn and abs(modulus - _TURN) < numbers.same_jump * _TURN:
        modulus = _TURN
    modulus = _usual(modulus, numbers)
    is_wrap = is_turn or _goes_on(series, steps, numbers) or _flickers(series, steps, numbers)
    return (steps, modulus) if is_wrap else (none, 0.0)


def _usual(modulus: float, numbers: Inspecting) -> float:
    """Replace a modulus by the usual one that it is near: an error of it would add up with each wrap."""
    near = min(_USUAL, key=lambda one: abs(modulus / one - 1.0))
    return near if abs(modulus / near - 1.0) < numbers.same_turn else modulus


def _are_alike(off: Floats, slack: float, others: Floats, numbers: Inspecting) -> bool:
    """Whether most jumps are off the middle one (jumps,) by no more than a slack, and the rest by the motion in one sample."""
    most = float(np.quantile(off, numbers.most_alike, method="higher"))
    return most <= slack and float(off.max()) <= slack + float(others.max(initial=0.0))


def _slopes(changes: Floats, steps: Integers) -> Floats:
    """Average the changes beside each jump, which are those of the motion."""
    usual = changes.copy()
    usual[steps] = np.nan
    padded = np.r_[np.nan, usual, np.nan]
    beside = np.stack([padded[steps], padded[steps + 2]])
    known = np.isfinite(beside)
    return np.where(known, beside, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)


def _goes_on(series: Series, steps: Integers, numbers: Inspecting) -> bool:
    """Whether the motion across some jump, undone, goes on in its direction for some readings on both sides.

    A spike returns at once, and a run that another one follows in the file does not go on. A slow motion takes more readings to
    leave the noise.
    """
    return any(_goes_on_for(length, series, steps, numbers) for length in (numbers.goes_on, numbers.goes_on_slowly))


def _goes_on_for(length: int, series: Series, steps: Integers, numbers: Inspecting) -> bool:
    bounds = np.r_[-1, steps, len(series) - 1]
    for place, step in enumerate(steps, start=1):
        if min(step - bounds[place - 1], bounds[place + 1] - step) < length:
            continue
        before, after = series.values[step - length + 1 : step + 1], series.values[step + 1 : step + 1 + length]
        against = -np.sign(series.changes[step])
        moved = against * np.array([before[-1] - before[0], after[-1] - after[0]])
        if (moved > numbers.least_motion * series.noise).all():
            return True
    return False


def _flickers(series: Series, steps: Integers, numbers: Inspecting) -> bool:
    """Whether noise takes the signal across the end of its range and back: lost readings would all be one value."""
    sides = series.values[steps], series.values[steps + 1]
    low, high = np.minimum(*sides), np.maximum(*sides)
    return len(steps) >= numbers.fewest_flickers and bool(np.ptp(low) > 0.0 and np.ptp(high) > 0.0)
