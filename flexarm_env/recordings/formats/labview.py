"""LabVIEW measurement files (.lvm): sections of tags, then columns of numbers with a comment in the last."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from flexarm_env.errors import InputError
from flexarm_env.recordings.cells import count_cells, cut, is_blank
from flexarm_env.recordings.columns import ColumnMap, quantity_of
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.formats.text import read_rows, text_lines
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.table import Table

# The specification of the LabVIEW measurement file.
_FIRST_LINE, _END, _SEGMENT = "LabVIEW Measurement", "***End_of_Header***", "Channels"
_SEPARATORS = {"Tab": "\t", "Comma": ","}
_TIME, _COMMENT = "X_Value", "Comment"


@dataclass(frozen=True)
class _Segment:
    """Rows under one header: its cells, its index in the file, the texts of the rows and their indices."""

    header: list[str]
    place: int
    rows: list[str]
    places: list[int]


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of a .lvm file by its column map; delimiter and decimal mark are the file's own.

    Segments with the same columns follow each other. Where the file holds no times, `X_Value` is `X0` + k `Delta_X`.

    Args:
        content: of the file.
        columns: its column map.

    Raises:
        InputError: naming row (line of the file, counted from 1) and column.
    """
    lines = text_lines(content)
    if not lines[0].startswith(_FIRST_LINE):
        raise InputError(
            f"row 1: is {quoted(lines[0])}, where such a file has {_FIRST_LINE!r}; rename it to .txt if it is a table"
        )
    layout, evenly = _layout(lines, columns or ColumnMap())
    first, *others = _segments(lines, layout, evenly)
    for other in others:
        if other.header != first.header:
            raise InputError(f"row {other.place + 1}: has other columns than row {first.place + 1}; save each segment to a file")
    segments = (first, *others)
    rows = [row for segment in segments for row in segment.rows]
    places = [place for one in segments for place in one.places]
    layout = _with_one_clock(first.header, rows, places, layout)
    return read_rows(rows, places, first.header, first.place + 1, layout)


def _with_one_clock(header: Sequence[str], rows: Sequence[str], places: Sequence[int], layout: ColumnMap) -> ColumnMap:
    """Find the times of a file with an `X_Value` left of each channel, which must be those of all channels that are read.

    Raises:
        InputError: at the first row in which two channels have different times.
    """
    clocks = _clocks(header, layout)
    for row, place in zip(rows, places, strict=True) if len(clocks) > 1 else ():
        cells = cut(row, layout.delimiter)
        times = [cells[clock].strip() for clock in clocks if clock < len(cells)]
        if len(set(times)) > 1:
            raise InputError(
                f"row {place + 1}: its channels have the times {' and '.join(map(quoted, times))}; "
                "write each channel to a file of its own, and name it by 'file'"
            )
    time = layout.sources.get("time")
    if not clocks or time is None or time.place != _TIME:
        return layout
    return replace(layout, sources=layout.sources | {"time": replace(time, place=clocks[0], key="index")})


def _clocks(header: Sequence[str], layout: ColumnMap) -> list[int]:
    """List the columns of times of the channels that a map names; none where all channels have one."""
    every = [number for number, cell in enumerate(header) if cell == _TIME]
    if len(every) < 2:
        return []
    channels = _channels(header, layout)
    return sorted({max(clock for clock in every if clock < channel) for channel in channels if channel > every[0]})


def _channels(header: Sequence[str], layout: ColumnMap) -> list[int]:
    """List the columns that a map names, without those of time."""
    places: dict[str | int | float, int] = {cell: number for number, cell in enumerate(header)}
    places |= {number: number for number in range(len(header))}
    named = [source.place for name, source in layout.sources.items() if quantity_of(name) != "time"]
    return sorted({places[place] for place in named if place in places})


def _layout(lines: Sequence[str], columns: ColumnMap) -> tuple[ColumnMap, bool]:
    """Read the file's own section: return the map with its delimiter and decimal mark, and whether no times are written."""
    line = next((line for line in lines if line.startswith("Separator")), "Separator\tTab")
    delimiter = _SEPARATORS.get(line.removeprefix("Separator")[1:].strip())
    if delimiter is None:
        raise InputError(f"has the separator {quoted(line)}; save it with one of {', '.join(_SEPARATORS)}")
    tags = _tags(lines, delimiter)
    # A comma that separates cells cannot be the decimal mark, and its own tag would be cut in two.
    decimal = "," if delimiter != "," and tags.get("Decimal_Separator", ["."])[0] == "," else "."
    return replace(columns, delimiter=delimiter, decimal=decimal), tags.get("X_Columns", ["One"])[0] == "No"


def _tags(lines: Sequence[str], delimiter: str) -> dict[str, list[str]]:
    """Read the tags of a section up to its end, each with its values, one for each channel."""
    found = {}
    for line in lines:
        if line.startswith(_END):
            break
        name, _, value = line.partition(delimiter)
        found[name.strip()] = [cell.strip() for cell in value.split(delimiter)]
    return found


def _segments(lines: Sequence[str], layout: ColumnMap, evenly: bool) -> Iterator[_Segment]:
    """Cut the lines into segments: each begins after the tags of its own, the first at least after those of the file."""
    ends = [row for row, line in enumerate(lines) if line.startswith(_END)]
    tagged = [row for row, line in enumerate(lines) if line.startswith(_SEGMENT + layout.delimiter)]
    if not ends or len(ends) != 1 + len(tagged):
        raise InputError(f"has {len(ends)} times {_END} for {1 + len(tagged)} headers; it is cut off, or changed")
    starts = ends[1:] or ends
    for number, (start, stop) in enumerate(zip(starts, [*tagged[1:], len(lines)], strict=True)):
        places = [row for row in range(start + 1, stop) if not is_blank(lines[row])]
        if not places:
            raise InputError(f"row {start + 1}: no columns follow; the file is cut off")
        header = [cell.strip() for cell in cut(lines[places[0]], layout.delimiter)]
        rows = [_uncommented(lines[row], header, layout.delimiter) for row in places[1:]]
        if evenly and _TIME in header:
            tags = _tags(lines[tagged[number] :] if tagged else [], layout.delimiter)
            rows = _with_times(rows, header, tags, layout)
        yield _Segment(header[:-1] if header[-1] == _COMMENT else header, places[0], rows, places[1:])


def _uncommented(row: str, header: Sequence[str], delimiter: str) -> str:
    """Cut the comment off a row, which may lack its cell."""
    if header[-1] != _COMMENT or count_cells(row, delimiter) != len(header):
        return row
    return row.rpartition(delimiter)[0] if '"' not in row else delimiter.join(cut(row, delimiter)[:-1])


def _with_times(rows: Sequence[str], header: Sequence[str], tags: Mapping[str, list[str]], layout: ColumnMap) -> list[str]:
    """Write the times X0 + k Delta_X of the channels that are read into the empty cells of rows."""
    place = header.index(_TIME)
    channels = [column - place - 1 for column in _channels(header, layout) if column > place] or [0]
    try:
        clocks = {
            channel: tuple(float(tags[name][channel].replace(layout.decimal, ".")) for name in ("X0", "Delta_X"))
            for channel in channels
        }
    except (KeyError, IndexError, ValueError):
        raise InputError("has neither times nor an X0 and a Delta_X; save it with X columns, or give time a rate") from None
    if len(set(clocks.values())) > 1:
        listed = " and ".join(f"{first:g} + k {step:g}" for first, step in sorted(set(clocks.values())))
        raise InputError(f"its channels have the times {listed}; write each channel to a file of its own, and name it by 'file'")
    first, step = clocks[channels[0]]
    timed = []
    for number, row in enumerate(rows):
        cells = row.split(layout.delimiter)
        if place < len(cells) and not cells[place].strip():
            cells[place] = repr(first + number * step).replace(".", layout.decimal)
        timed.append(layout.delimiter.join(cells))
    return timed


FORMAT = Format("LabVIEW measurement file", (".lvm",), ("column", "index"), read)
