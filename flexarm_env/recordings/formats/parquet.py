"""Parquet tables: FlexArm's own header as names of columns, or any other by a column map; lists by `name[index]`, from 0."""

from __future__ import annotations

import io
import re
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import ColumnMap, Source
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.formats.extras import library
from flexarm_env.recordings.formats.lerobot import EPISODE, FRAME, STAMP, exact_times
from flexarm_env.recordings.formats.timestamps import check_unscaled
from flexarm_env.recordings.headers import absence, header_sources
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.table import MOST_LINES, Table

_ELEMENT = re.compile(r"(.*)\[(\d{1,9})\]")


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of a Parquet file.

    Args:
        content: of the file.
        columns: its column map, if there is one.

    Raises:
        InputError: for a file that pyarrow cannot read, and for a column that is absent or holds no numbers.
    """
    arrow = library("pyarrow", "Parquet file")
    file, names = _opened(io.BytesIO(content))
    if file.metadata.num_rows > MOST_LINES:
        raise InputError(f"has {file.metadata.num_rows} rows, the limit is {MOST_LINES}; cut it into shorter recordings")
    layout = columns or ColumnMap()
    found = _places(names, layout)
    try:
        episodes = _whole_numbers(file, EPISODE) if EPISODE in names else np.zeros(0, np.int64)
        values = {
            name: _numbers(name, file.read([column], use_threads=False).column(0), element, source, arrow.types)
            for name, (source, column, element) in found.items()
        }
        _check_truth(file, {column: name for name, (_, column, _) in found.items() if name not in layout.conditions}, arrow.types)
        if layout.frame_rate and "time" in found and found["time"][1] == STAMP and FRAME in names:
            values["time"] = exact_times(values["time"], _whole_numbers(file, FRAME).astype(float), layout.frame_rate)
    except (arrow.ArrowException, OSError, UnicodeDecodeError) as error:
        raise InputError(f"is damaged: {quoted(str(error))}") from None
    sources = {name: source for name, (source, _, _) in found.items()}
    return Table(values, sources, episodes=episodes.tolist())


def read_header(file: BinaryIO) -> list[str]:
    """Read the names of the columns of an open Parquet file.

    Raises:
        InputError: for a file that pyarrow cannot read.
    """
    return _opened(file)[1]


def _opened(file: BinaryIO) -> tuple[Any, list[str]]:
    """Open a Parquet file; also give the names of its columns."""
    parquet = library("pyarrow.parquet", "Parquet file")
    arrow = library("pyarrow", "Parquet file")
    try:
        opened = parquet.ParquetFile(file)
        return opened, list(opened.schema_arrow.names)
    except (arrow.ArrowException, OSError, ValueError) as error:
        raise InputError(f"is damaged or no Parquet file: {quoted(str(error))}") from None


def _places(names: list[str], layout: ColumnMap) -> dict[str, tuple[Source, str, int | None]]:
    """Find for each quantity its source, the name of its column, and the element of its lists (None for plain numbers)."""
    if layout.refines:
        return {name: (source, names[int(source.place)], None) for name, source in header_sources(names, layout).items()}
    found: dict[str, tuple[Source, str, int | None]] = {}
    for name, source in layout.sources.items():
        match = None if source.place in names else _ELEMENT.fullmatch(str(source.place))
        place = match[1] if match else source.place
        if isinstance(place, int) and place < len(names):
            place = names[place]
        if place not in names:
            raise InputError(f"column '{name}': no {quoted(str(place))} in the header{absence(str(place), names)}")
        element = int(match[2]) if match else None
        twin = next((other for other, (_, *own) in found.items() if own == [place, element]), None)
        if twin:
            raise InputError(f"columns '{twin}' and '{name}': both map to {quoted(str(source.place))}; correct one of them")
        if names.count(str(place)) > 1:
            raise InputError(f"column '{name}': the header has {quoted(str(place))} twice; save it with names that differ")
        found[name] = (source, str(place), element)
    return found


def _check_truth(file: Any, names: dict[str, str], types: Any) -> None:
    """Refuse columns of true and false, which only a condition may be.

    Args:
        file: that has them.
        names: by the name of a column, that of its quantity.
        types: of pyarrow.
    """
    for column, name in names.items():
        if types.is_boolean(file.schema_arrow.field(column).type):
            raise InputError(f"column '{name}': is 'bool', no numbers; name another")


def _whole_numbers(file: Any, name: str) -> NDArray[np.int64]:
    """Read a column of whole numbers."""
    column = file.read([name]).column(0)
    if column.null_count or not library("pyarrow", "Parquet file").types.is_integer(column.type):
        raise InputError(f"column '{name}': is {quoted(str(column.type))} with {column.null_count} empty rows, no whole numbers")
    return np.asarray(column.to_numpy(), dtype=np.int64)


def _numbers(name: str, column: Any, element: int | None, source: Source, types: Any) -> NDArray[np.float64]:
    """Read the numbers of a column; times with a unit of their own are converted to that of the map."""
    kind = column.type
    is_list = types.is_list(kind) or types.is_large_list(kind) or types.is_fixed_size_list(kind)
    if is_list != (element is not None):
        how = "name one of its elements, as [0] after the column's name" if is_list else "leave [...] out"
        raise InputError(f"column '{name}': is {quoted(str(kind))}; {how}")
    if element is not None:
        rows = column.combine_chunks()
        lengths = rows.value_lengths().to_numpy(zero_copy_only=False) if not types.is_fixed_size_list(kind) else [kind.list_size]
        if element >= np.min(lengths, initial=element + 1):
            raise InputError(f"column '{name}': its lists have {int(np.min(lengths))} elements, no [{element}]; count from 0")
        column = library("pyarrow.compute", "Parquet file").list_element(rows, element)
        kind = kind.value_type
    if types.is_timestamp(kind) or types.is_duration(kind):
        check_unscaled(name, source)
        ticks = column.cast("int64").to_numpy(zero_copy_only=False)
        return (ticks - ticks[:1]).astype(np.float64) * units.factor(kind.unit, "s") / units.factor(source.unit, "s")
    if not (types.is_integer(kind) or types.is_floating(kind) or types.is_decimal(kind) or types.is_boolean(kind)):
        raise InputError(f"column '{name}': is {quoted(str(kind))}, no numbers; name another")
    return np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)


FORMAT = Format("Parquet file", (".parquet",), ("column", "index"), read, needs_map=False, header=read_header)
