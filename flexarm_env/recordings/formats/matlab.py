"""MATLAB files with columns of a recording: vectors, and rows or columns of matrices, in structs and cells too."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import ColumnMap, Source
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.formats.matlab_file import DamagedError, Variable, VersionError, variables
from flexarm_env.recordings.formats.matlab_paths import find_numbers
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.table import Table

Floats = NDArray[np.float64]


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of a .mat file (version 7 or older) by its column map.

    Args:
        content: of the file.
        columns: its column map, without which no variable is read.

    Raises:
        InputError: for version 7.3, a damaged file, or a variable that is absent or no vector of numbers.
    """
    sources = {} if columns is None else dict(columns.sources)
    try:
        found = variables(content)
        conditions = {} if columns is None else columns.conditions
        values = {name: _column(name, source, found, name in conditions) for name, source in sources.items()}
    except VersionError as error:
        raise InputError(f"is {error}, which is not read; save('FILE.mat', '-v7')") from None
    except DamagedError:
        raise InputError("is damaged or no MATLAB file; in MATLAB: save('FILE.mat', '-v7')") from None
    lengths = {name: len(value) for name, value in values.items() if name not in conditions}
    longest = max(lengths.values(), default=0)
    if "time" in values and len(values["time"]) == 1 < longest:
        values["time"], sources["time"] = _even_time(float(values["time"][0]), sources["time"], longest)
        lengths["time"] = longest
    if len(set(lengths.values())) > 1:
        raise InputError(f"its variables differ in length ({lengths}); give vectors of one length")
    return Table(values, sources)


def _column(name: str, source: Source, found: Mapping[str, Variable], truth: bool) -> Floats:
    """Read the vector of one quantity, of true and false where it may be."""
    path = str(source.place)
    try:
        numbers = find_numbers(found, path, truth)
    except InputError as error:
        raise InputError(f"column '{name}': {error}") from None
    if numbers.ndim > 2 and 1 in numbers.shape:  # Simulink gives a signal of several columns as m × 1 × n
        numbers = numbers.reshape([size for size in numbers.shape if size > 1] or [1])
    for axis, (kind, index) in enumerate((("row", source.row), ("index", source.cut))):
        if index is not None:
            numbers = _slice(numbers, axis, index, f"column '{name}': {kind} {index}, but {quoted(path)} is")
    if not 0 < numbers.size == max(numbers.shape):
        shape = "×".join(map(str, numbers.shape))
        hint = f"name one by row = 0 to {numbers.shape[0] - 1}, or index = 0 to {numbers.shape[-1] - 1}, from 0"
        how = hint if numbers.size and numbers.ndim == 2 else "save it as n × 1"
        raise InputError(f"column '{name}': {quoted(path)} is {shape}, not a vector; {how}")
    return numbers.ravel()


def _slice(numbers: Floats, axis: int, index: int, where: str) -> Floats:
    if numbers.ndim != 2 or index >= numbers.shape[axis]:
        raise InputError(f"{where} {'×'.join(map(str, numbers.shape))}; count from 0")
    return np.take(numbers, [index], axis=axis)


def _even_time(step: float, source: Source, count: int) -> tuple[Floats, Source]:
    """Make times of a single number: the time between samples, or the rate if its unit is one of frequency."""
    if source.unit and units.converts(source.unit, "Hz"):
        rate = step * units.factor(source.unit, "Hz", source.scale)
        step = 1.0 / rate if rate else 0.0
        source = replace(source, unit="s", scale=1.0)
    if not (np.isfinite(step) and step > 0):
        raise InputError(f"column 'time': {quoted(str(source.place))} is one number, {step}; it must be the time between samples")
    with np.errstate(over="ignore"):  # an overflow is reported with its row
        return step * np.arange(count, dtype=np.float64), source


FORMAT = Format("MATLAB file", (".mat",), ("variable",), read, matrices=True)
