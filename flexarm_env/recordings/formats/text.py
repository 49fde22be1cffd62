"""Text tables: FlexArm's own CSV files, and any others by a column map."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import BinaryIO

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.recordings.cells import MOST_CELLS, count_cells, cut, is_blank, is_number, read_numbers, usual_width
from flexarm_env.recordings.columns import ColumnMap
from flexarm_env.recordings.conditions import add_condition
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.formats.timestamps import check_unscaled, is_stamp, read_stamps
from flexarm_env.recordings.headers import header_sources, states_units
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.table import MOST_LINES, Table

#: Bytes that are read of a file for its header; as many again while they are remarks.
_HEAD = 1 << 16
#: The first line that tells Excel the delimiter.
_EXCEL = re.compile(r"sep=(.)[;,\t]*+")


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of a text file: one with FlexArm's own header, or any other by a column map.

    Args:
        content: of the file.
        columns: its column map, if there is one.

    Raises:
        InputError: naming row (line of the file, counted from 1) and column.
    """
    lines = text_lines(content)
    layout, skip = _excel(lines, columns or ColumnMap())
    first, conditions, unread = _preamble(lines, skip, layout.header_prefix)
    header, body = _header(lines, first, layout)
    body += bool(header) and body < len(lines) and states_units(lines[body], header, body, layout)
    rows = [row for row in range(body, len(lines)) if not is_blank(lines[row], layout.delimiter)]
    while rows and _is_remark(lines[rows[-1]], lines[rows[0]], layout):
        unread |= _add_remark(lines, rows.pop(), conditions)
    table = read_rows([lines[row] for row in rows], rows, header, body, layout)
    return replace(table, conditions=conditions, unread=unread, notes=tuple(unread.values()))


def read_rows(rows: list[str], places: Sequence[int], header: list[str], body: int, layout: ColumnMap) -> Table:
    """Read the numbers of rows of text.

    Args:
        rows: the text of each sample.
        places: the index of each in the file.
        header: its cells; [] where there is none.
        body: the index of the line after the header.
        layout: the file's column map; without sources for FlexArm's own header.

    Raises:
        InputError: naming row (line of the file, counted from 1) and column.
    """
    sources = header_sources(header, layout, f"row {body}")
    if not rows:
        raise InputError(f"has no samples after row {body}; it needs at least two rows of numbers")
    labels = {int(source.place): name for name, source in sources.items()}
    counts = [count_cells(row, layout.delimiter) for row in rows]
    if max(counts) > MOST_CELLS:
        raise InputError(f"has rows of {max(counts)} cells, the limit is {MOST_CELLS}; is the delimiter right?")
    width = len(header) if layout.refines else usual_width(counts)
    if any(source.key == "column" for source in layout.sources.values()):
        _check_header(header, body, labels, rows, width, layout.delimiter)
    even = counts.count(width) == len(rows)
    stamped = _column_of_stamps(rows[0], labels, layout)
    numbers = {place: name for place, name in labels.items() if place != stamped}
    table = read_numbers(rows, places, numbers, width, even, layout)
    values = {name: table[:, i] for i, name in enumerate(numbers.values())}
    if stamped is not None:
        check_unscaled("time", sources["time"])
        times = read_stamps(rows, places, stamped, layout.delimiter)
        values["time"] = times / units.factor(sources["time"].unit, "s")
    return Table(values, sources, lines=[row + 1 for row in places])


def read_header(file: BinaryIO) -> list[str]:
    """Read the cells of the header of an open file that has no column map.

    Raises:
        InputError: if there is no such header.
    """
    head = file.read(_HEAD)
    while _has_remarks_alone(head) and (more := file.read(len(head))):
        head += more
    whole, _, _ = head.replace(b"\r", b"\n").rpartition(b"\n")  # the last line may be cut off, within a character, too
    lines = _decode(whole or head).split("\n")
    layout, skip = _excel(lines, ColumnMap())
    first, _, _ = _preamble(lines, skip, layout.header_prefix)
    return _header(lines, first, layout)[0]


def _has_remarks_alone(head: bytes) -> bool:
    """Whether the whole lines at the beginning of a file are blank or remarks."""
    *lines, _ = head.removeprefix(b"\xef\xbb\xbf").replace(b"\r", b"\n").split(b"\n")
    return all(not line.strip() or line.lstrip().startswith(b"#") for line in lines)


def text_lines(content: bytes) -> list[str]:
    """Cut a file's content into lines.

    Raises:
        InputError: for more lines than can be held, and for bytes that are no text in UTF-8.
    """
    count = max(content.count(b"\n"), content.count(b"\r"))
    if count > MOST_LINES:
        raise InputError(f"has {count} lines, the limit is {MOST_LINES}; cut it into shorter recordings")
    return _decode(content).replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _decode(content: bytes) -> str:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"row {row}: is not UTF-8 text; save it as CSV in UTF-8") from None
    if "\0" in text:
        raise InputError("is a binary file, not text; save it as CSV in UTF-8")
    return text


def _excel(lines: Sequence[str], layout: ColumnMap) -> tuple[ColumnMap, int]:
    """Take up a first line such as `sep=;`; return the layout and the number of lines to skip."""
    line = _EXCEL.fullmatch(lines[0].strip())
    found, skip = layout, layout.skip_rows
    if line is not None and not skip:
        if layout.delimiter not in (ColumnMap.delimiter, line[1]):
            raise InputError(
                f"row 1: has {quoted(line[0])}, but [columns] has delimiter = {layout.delimiter!r}; leave it out there"
            )
        found, skip = replace(layout, delimiter=line[1]), 1
    if found.decimal == found.delimiter:
        raise InputError(
            f"decimal and delimiter are both {found.decimal!r}; set delimiter = ';' or what the file has in [columns]"
        )
    return found, skip


def _preamble(lines: Sequence[str], skip: int, mark: str) -> tuple[int, dict[str, float], dict[str, str]]:
    """Count the lines before the header, and read the conditions that they state, with notes on those that cannot be read.

    A mark of headers may be that of remarks, as numpy writes it: then the last of those lines is the header.
    """
    conditions: dict[str, float] = {}
    unread: dict[str, str] = {}
    count = len(lines) - (not lines[-1])
    if skip and skip >= count:
        raise InputError(f"skip_rows is {skip}, but the file has {count} lines; write the number of lines before its header")
    first = skip
    while first < len(lines) and (is_blank(lines[first]) or lines[first].lstrip().startswith("#")):
        first += 1
    marked = [row for row in range(skip, first) if lines[row].startswith(mark)] if mark.startswith("#") else []
    header = marked[-1] if marked else first
    if header == len(lines):
        raise InputError("has no header row; write one such as 'time [s],current [A],arm_angle [rad]'")
    for row in range(skip, header):
        unread |= _add_remark(lines, row, conditions)
    return header, conditions, unread


def _add_remark(lines: Sequence[str], row: int, conditions: dict[str, float]) -> dict[str, str]:
    """Add the condition that a remark states; return a note on one that cannot be read, by its name."""
    try:
        return {name: f"row {row + 1}: {note}" for name, note in add_condition(lines[row].strip(), conditions).items()}
    except InputError as error:
        raise InputError(f"row {row + 1}: {error}") from None


def _is_remark(line: str, first: str, layout: ColumnMap) -> bool:
    """Whether a line after the rows is a remark, and no row whose first cell is a spreadsheet's error, such as #N/A.

    Args:
        line: of the file.
        first: the first line after the header.
        layout: delimiter and decimal mark.
    """
    if not line.lstrip().startswith("#"):
        return False
    if first.lstrip().startswith("#") or count_cells(line, layout.delimiter) != count_cells(first, layout.delimiter):
        return True
    _, *others = cut(line, layout.delimiter)
    if layout.delimiter == " ":  # a remark of as many words
        return not all(is_number(cell, layout.decimal) or cell.startswith("#") for cell in others)
    return not any(cell.strip() for cell in others)  # those that a spreadsheet adds


def _header(lines: Sequence[str], first: int, layout: ColumnMap) -> tuple[list[str], int]:
    """Cut the header into cells ([] where a mapped file has none); return them and the index of the line after it."""
    mark = layout.header_prefix
    last = first
    if mark:
        if not lines[first].startswith(mark):
            raise InputError(f"row {first + 1}: no header; [columns] says that it starts with {mark!r}")
        while last + 1 < len(lines) and lines[last + 1].startswith(mark):
            last += 1
    header = cut(lines[last].removeprefix(mark), layout.delimiter)
    if any(is_number(cell, layout.decimal) for cell in header):
        by_index = layout.sources and all(source.key == "index" for source in layout.sources.values())
        if by_index and not mark:
            return [], last
        raise InputError(f"row {last + 1}: numbers where the header should be; write one such as 'time [s],current [A]'")
    if len(header) == 1:
        for other, word in ((";", "semicolons"), ("\t", "tabs")):
            if other in header[0]:
                raise InputError(
                    f"row {last + 1}: the columns are separated by {word}; save with commas and decimal"
                    f" points, or give a [columns] table with delimiter = {other!r}"
                )
    return header, last + 1


def _column_of_stamps(row: str, labels: Mapping[int, str], layout: ColumnMap) -> int | None:
    """Find the column of time if it holds dates with times or times of day, which need no unit; other columns hold numbers."""
    place = next((place for place, name in labels.items() if name == "time"), None)
    cells = cut(row, layout.delimiter) if place is not None and ":" in row else []
    return place if place is not None and place < len(cells) and is_stamp(cells[place]) else None


def _check_header(
    header: Sequence[str], row: int, labels: dict[int, str], rows: Sequence[str], width: int, delimiter: str
) -> None:
    """Refuse a header with cells by which columns cannot be counted. Empty ones may end it, and nameless columns the rows."""
    named = len(header)
    while named and not header[named - 1].strip():
        named -= 1
    is_short = named < width and (delimiter == " " or (named == width - 1 and _begin_with_their_number(rows, delimiter)))
    if named > width or is_short:
        beyond = next((f", none for '{name}'" for index, name in labels.items() if index >= width), "")
        asked = "is there a blank in a name?" if delimiter == " " else "does the first column lack a name?"
        hint = f"{asked} give 'index' in place of 'column'" if is_short or delimiter == " " else "is the delimiter right?"
        raise InputError(f"row {row}: the header has {named} names, the rows have {width} cells{beyond}; {hint}")


def _begin_with_their_number(rows: Sequence[str], delimiter: str) -> bool:
    """Whether the first cells are the numbers of the rows, as those for which R writes no name."""
    return all(cut(text, delimiter)[0].strip() == str(number) for number, text in enumerate(rows, 1))


FORMAT = Format("text table", (".csv",), ("column", "index"), read, needs_map=False, also=(".txt", ".dat"), header=read_header)
