"""Recordings as the text of a CSV file with names and units in its header."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flexarm_env.recordings.columns import UNITS
from flexarm_env.recordings.conditions import CONDITIONS
from flexarm_env.sensors import known_sensors

if TYPE_CHECKING:
    from flexarm_env.recordings.recording import Recording


def csv_text(recording: Recording) -> str:
    """Format a recording: conditions as remarks, a header, and a row for each sample."""
    columns = {"time": recording.time, recording.input_kind: recording.command}
    columns |= {name: recording.signals[name] for name in known_sensors() if name in recording.signals}
    if recording.reference is not None:
        columns["reference"] = recording.reference
    remarks = [f"# {name} = {value!r} {CONDITIONS.get(name, '')}".rstrip() for name, value in recording.conditions.items()]
    header = ",".join(f"{name} [{UNITS[name]}]" for name in columns)
    rows = zip(*map(_cells, columns.values()), strict=True)
    return "\n".join([*remarks, header, *map(",".join, rows), ""])


def _cells(values: NDArray[np.float64]) -> list[str]:
    """Write numbers with all their digits, and an empty cell for NaN."""
    return ["" if value != value else repr(value) for value in values.tolist()]
