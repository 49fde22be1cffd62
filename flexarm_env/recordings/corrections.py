"""Corrections of a signal that a column map states: readings that are none, a wrapped count, a late clock."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.recordings.checks import LARGEST_READING
from flexarm_env.recordings.resolution import repeated_readings
from flexarm_env.sensors import known_sensors

Floats = NDArray[np.float64]

#: Entries of a column map that hold for signals alone, and the one that holds for `time`, too.
SIGNAL_KEYS, TIME_KEYS = ("ignore", "range", "repeats", "wrap", "shift"), ("shift",)

#: Rows for which a reading may be held.
MOST_HELD = 1_000_000


@dataclass(frozen=True)
class Corrections:
    """Corrections of one signal, in SI, in the order in which they are made.

    Attributes:
        ignore: spans of time [s] in which the signal was not measured, each from its start up to its stop.
        ends: of the sensor's range; readings at or beyond them were not measured. None for no ends.
        repeats: rows for which each reading is held; only the first of them was measured.
        wrap: modulus of a counter or an angle that starts over; 0 for none.
        shift: time [s] by which the signal is late.
    """

    ignore: tuple[tuple[float, float], ...] = ()
    ends: tuple[float, float] | None = None
    repeats: int = 1
    wrap: float = 0.0
    shift: float = 0.0

    def apply(self, time: Floats, values: Floats) -> Floats:
        """Correct a signal.

        Args:
            time: (n,) [s], from 0.
            values: (n,) in SI, NaN where nothing was measured.

        Returns:
            The corrected signal (n,), a copy.
        """
        absent = np.isnan(values)
        if self.ends:
            absent |= (values <= self.ends[0]) | (values >= self.ends[1])
        for start, stop in self.ignore:
            absent |= (time >= start) & (time < stop)
        if self.repeats > 1:
            absent |= repeated_readings(values, self.repeats)
        found = np.where(absent, np.nan, values)
        there = np.isfinite(found)
        # Readings beyond any arm's, which are refused later, would leave no digit to the others.
        if self.wrap and np.abs(found[there]).max(initial=0.0) <= LARGEST_READING:
            found[there] = np.unwrap(found[there], period=self.wrap)
        return _moved(time, found, self.shift) if self.shift else found


def read_corrections(entry: Mapping[str, Any], unit: str) -> Corrections:
    """Read the corrections in an entry of a column map.

    Args:
        entry: of one signal, or of time.
        unit: of the signal in SI.

    Raises:
        InputError: for a value that makes no sense, with the key and without the name of the entry.
    """
    ends = _ends(entry["range"], unit) if "range" in entry else None
    repeats = entry.get("repeats", 1)
    if isinstance(repeats, bool) or not isinstance(repeats, int) or ("repeats" in entry and not 2 <= repeats <= MOST_HELD):
        raise InputError(
            f"repeats is {repeats!r}; write the number of rows for which a reading is held, 2 or more, up to {MOST_HELD}"
        )
    wrap = _quantity("wrap", entry.get("wrap", 0.0), unit)
    if "wrap" in entry and not 0.0 < wrap < math.inf:
        raise InputError(f"wrap is {entry['wrap']!r}; write the size of the jump, such as '6.2832 {unit}'")
    shift = _quantity("shift", entry.get("shift", 0.0), "s")
    if not math.isfinite(shift):
        raise InputError(f"shift is {entry['shift']!r}; write the time by which the signal is late, such as '0.5 s'")
    return Corrections(_spans(entry.get("ignore", [])), ends, repeats, wrap, shift)


def corrected(arrays: Mapping[str, Floats], corrections: Mapping[str, Corrections]) -> tuple[dict[str, Floats], tuple[str, ...]]:
    """Correct the signals of a file. NaN of any kind becomes the plain one, which a file gives back.

    Args:
        arrays: (n,) by column name, in SI, time among them.
        corrections: by column name; the shift of "time" is added to that of every signal.

    Returns:
        The arrays, and notes on the readings that there are, a line each.

    Raises:
        InputError: for a shift that is longer than the recording.
    """
    found, notes = dict(arrays), []
    time = arrays["time"]
    late = corrections["time"].shift if "time" in corrections else 0.0
    for name in known_sensors():
        if name not in arrays:
            continue
        own = corrections.get(name, Corrections())
        own = replace(own, shift=own.shift + late)
        if abs(own.shift) > time[-1]:
            raise InputError(f"column '{name}': shift is {own.shift:g} s, but the recording lasts {time[-1]:g} s; correct it")
        found[name] = own.apply(time, arrays[name])
        absent = int(np.isnan(found[name]).sum())
        if corrections and 0 < absent < len(time):
            notes.append(f"'{name}' was measured in {len(time) - absent} of {len(time)} rows")
        if own.shift:
            notes.append(_shift_note(name, own.shift, float(np.median(np.diff(time)))))
    return found, tuple(notes)


def _shift_note(name: str, shift: float, sample_time: float) -> str:
    """Describe how a signal was moved in time: by whole rows, and what is left of the shift."""
    rows = round(shift / sample_time)
    rest = shift - rows * sample_time
    left = f"; {1e3 * rest:.3g} ms of it are less than a row" if abs(rest) > 1e-6 * sample_time else ""
    count = f"{abs(rows)} row{'' if abs(rows) == 1 else 's'}"
    return f"'{name}' was moved by {count}, {'back' if rows >= 0 else 'forward'} in time{left}"


def _moved(time: Floats, values: Floats, shift: float) -> Floats:
    """Move the readings of a late signal back in time, each to the nearest row, by a whole number of usual steps.

    Nothing is interpolated: a reading keeps its value and its noise. Rows that no reading comes to are not measured.
    """
    step = float(np.median(np.diff(time)))
    there = np.flatnonzero(~np.isnan(values))
    aim = time[there] - round(shift / step) * step
    row = np.clip(np.searchsorted(time, aim), 1, len(time) - 1)
    row -= aim - time[row - 1] < time[row] - aim
    off = np.abs(time[row] - aim)
    near = np.flatnonzero(off <= 0.5 * step)
    near = near[np.argsort(-off[near], kind="stable")]  # of two that meet in a row, the nearer is written last
    found = np.full(len(values), np.nan)
    found[row[near]] = values[there[near]]
    return found


def _quantity(key: str, value: Any, unit: str) -> float:
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise InputError(f"{key} is {value!r}; write a quantity such as '0.5 {unit}'")
    try:
        return units.quantity(value, unit)
    except InputError as error:
        raise InputError(f"{key}: {error}") from None


def _ends(value: Any, unit: str) -> tuple[float, float]:
    if isinstance(value, list | tuple) and len(value) == 2:
        low, high = (_quantity("range", end, unit) for end in value)
        if low < high:
            return low, high
    raise InputError(f"range is {value!r}; write the two ends of the sensor's range, such as ['-1.5 {unit}', '1.5 {unit}']")


def _spans(value: Any) -> tuple[tuple[float, float], ...]:
    spans = []
    for span in value if isinstance(value, list | tuple) else [None]:
        ends = [_quantity("ignore", end, "s") for end in span] if isinstance(span, list | tuple) else []
        if len(ends) != 2 or not ends[0] < ends[1]:
            raise InputError(f"ignore is {value!r}; write spans of time, such as [[0, '1.0 s']]")
        spans.append((ends[0], ends[1]))
    return tuple(spans)
