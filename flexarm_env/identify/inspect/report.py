"""Faults put into words: quantities with their units, and the lines of a column map that mend them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from flexarm_env.identify.inspect.fault import KINDS, Fault
from flexarm_env.recordings.columns import UNITS
from flexarm_env.recordings.recording import Recording

#: Kinds whose value has the signal's unit, and those whose value is a time [s].
_IN_UNIT = ("wrap", "rail", "constant", "spike", "dropout")
_IN_SECONDS = ("clock", "glued", "restart")


def fault(
    recording: Recording,
    signal: str,
    kind: str,
    value: float | None,
    predicate: str,
    hint: str = "",
    rows: ArrayLike | None = None,
    other: str = "",
) -> Fault:
    """Make a fault of a recording.

    Args:
        recording: that shows it.
        signal: at fault; "" where all are.
        kind: one of `KINDS`.
        value: its size; None where it has none.
        predicate: of the sentence whose subject is the signal, or the whole sentence where there is none.
        hint: the line that mends it.
        rows: samples that show it; None where all do.
        other: the other signal of an exchange, or the one that could be at fault in its place.
    """
    assert kind in KINDS
    unit = UNITS[signal] if kind in _IN_UNIT else "s" if kind in _IN_SECONDS else ""
    samples = () if rows is None else tuple(int(row) for row in np.atleast_1d(rows))
    share = len(samples) / len(recording) if rows is not None else 1.0
    message = f"{signal} {predicate}".strip()
    return Fault(recording.name, recording.source, signal, kind, value, unit, message, hint, samples, share, other)


def quantity(value: float, unit: str) -> str:
    """Format a value with its unit: "1.5 V"."""
    return f"{value:.5g} {unit}".strip()


def shown(signal: str, value: float) -> str:
    """Format a reading of a signal with its unit."""
    return quantity(value, UNITS[signal])


def stretches(recording: Recording, rows: Sequence[int] | np.ndarray) -> list[tuple[float, float]]:
    """Join samples in a row to stretches of time [s], each from its first sample to just before the next sound one."""
    rows = np.asarray(rows)
    cuts = np.flatnonzero(np.diff(rows) > 1)
    first, last = rows[np.r_[0, cuts + 1]], rows[np.r_[cuts, len(rows) - 1]]
    half = 0.5 * recording.sample_time
    return [(float(recording.time[a] - half), float(recording.time[b] + half)) for a, b in zip(first, last, strict=True)]


def ignore(recording: Recording, signal: str, rows: np.ndarray, most: int) -> str:
    """Write the line that leaves out some samples of a signal; "" where it would be longer than a person reads."""
    found = stretches(recording, rows)
    if len(found) > most:
        return ""
    return f"{signal} = {{ ignore = [{', '.join(f'[{max(a, 0.0):.6g}, {b:.6g}]' for a, b in found)}] }}"


def row_list(rows: np.ndarray, most: int) -> str:
    """Name the samples, counted from 1, in a few words: "samples 1201 to 1210, 2004 and 3 more"."""
    cuts = np.flatnonzero(np.diff(rows) > 1)
    first, last = rows[np.r_[0, cuts + 1]] + 1, rows[np.r_[cuts, len(rows) - 1]] + 1
    parts = [str(a) if a == b else f"{a} to {b}" for a, b in zip(first[:most], last[:most], strict=True)]
    more = len(first) - most
    noun = "sample" if len(rows) == 1 else "samples"
    return f"{noun} {', '.join(parts)}" + (f" and {more} more" if more > 0 else "")
