"""The columns of a recording, checked and corrected."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError
from flexarm_env.recordings.checks import check_time, check_values, with_held_command
from flexarm_env.recordings.columns import Source, check_names
from flexarm_env.recordings.corrections import corrected

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Samples:
    """Columns of a recording of n samples, in SI.

    Attributes:
        input_kind: name of the command's column.
        columns: (n,) each, by name.
        notes: one line each on how they were corrected.
    """

    input_kind: str
    columns: dict[str, Floats]
    notes: tuple[str, ...]


def samples_of(arrays: dict[str, Floats], lines: Sequence[int] = (), sources: Mapping[str, Source] | None = None) -> Samples:
    """Check (n,) arrays in SI, by column name, and correct signals.

    Args:
        arrays: by column name; time is shifted to start at 0.
        lines: the line of each sample in its file, for messages; empty where there is none.
        sources: the columns in a file, with their corrections; None for arrays from elsewhere.

    Raises:
        InputError: for columns that make no recording, and for numbers that are not plausible.
    """
    kind = check_names(tuple(arrays))
    lengths = {column: len(values) for column, values in arrays.items()}
    if len(set(lengths.values())) > 1:
        raise InputError(f"lengths differ ({lengths}); give arrays of one length")
    if lengths["time"] < 2:
        raise InputError(f"has {lengths['time']} samples; it needs at least two")
    with np.errstate(over="ignore", invalid="ignore"):
        arrays = arrays | {"time": arrays["time"] - arrays["time"][0]}
    check_time(arrays["time"], lines)
    corrections = {column: source.corrections for column, source in (sources or {}).items()}
    arrays, notes = corrected(arrays, corrections)
    if sources is not None:
        arrays[kind], note = with_held_command(arrays[kind], kind, lines)
        notes = (*notes, note) if note else notes
    check_values(arrays, lines)
    return Samples(kind, arrays, notes)
