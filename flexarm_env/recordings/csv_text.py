"""Recordings as the text of a CSV file with names and units in its header."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from flexarm_env.recordings.columns import UNITS
from flexarm_env.recordings.conditions import unit_of

Floats = NDArray[np.float64]


def csv_text(columns: Mapping[str, Floats], conditions: Mapping[str, float]) -> str:
    """Format the columns of a recording: conditions as remarks, a header, and a row for each sample.

    Args:
        columns: (n,) in SI, by name; NaN leaves a cell empty.
        conditions: in SI.
    """
    remarks = [f"# {name} = {value!r} {unit_of(name, value)}".rstrip() for name, value in conditions.items()]
    header = ",".join(f"{name} [{UNITS[name]}]" for name in columns)
    rows = zip(*map(_cells, columns.values()), strict=True)
    return "\n".join([*remarks, header, *map(",".join, rows), ""])


def _cells(values: Floats) -> list[str]:
    """Write numbers with all their digits, and an empty cell for NaN."""
    return ["" if value != value else repr(value) for value in values.tolist()]
