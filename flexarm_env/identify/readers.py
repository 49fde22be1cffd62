"""Files to columns of raw numbers: text tables and MATLAB's .mat. Every fault is one line with its place."""

from __future__ import annotations

import contextlib
import csv
import difflib
import re
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.identify.columns import ColumnMap, Source, check_names, native_sources

LARGEST_FILE = 256 * 2**20
CONDITIONS = {"payload": "kg", "start": "s"}

_CONDITION = re.compile(r"#+\s*([A-Za-z_]\w*)\s*(?:\[(.*?)\]\s*)?([=:])\s*(.*?)\s*")
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d+,\d+\s*")


@dataclass(frozen=True)
class Table:
    """What a file holds, before units.

    Attributes:
        values: (n,) float64 by FlexArm name, in the file's units.
        sources: by FlexArm name, the unit, sign and scale of those numbers.
        conditions: known conditions in SI, such as payload [kg].
        lines: for each sample its line in the file, counted from 1; empty for .mat, which has none.
    """

    values: dict[str, NDArray[np.float64]]
    sources: dict[str, Source]
    conditions: dict[str, float] = field(default_factory=dict)
    lines: Sequence[int] = ()


def shown(text: str) -> str:
    """Return a file's text in quotes, short enough for a message, and on one line."""
    return repr(text if len(text) <= 40 else text[:37] + "...")


def fault(path: Path, what: object) -> InputError:
    """Return the error for a file, with escapes for whatever in its path or content would break the line."""
    return InputError("".join(c if c.isprintable() else repr(c)[1:-1] for c in f"{path}: {what}"))


def read_bytes(path: Path) -> bytes:
    """Return the content of a regular file.

    Raises:
        InputError: if it is absent, empty, larger than `LARGEST_FILE`, no file, or not to be opened.
    """
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):  # not opened: a pipe would wait for ever
            content = None
        else:
            content = path.read_bytes() if status.st_size <= LARGEST_FILE else b""
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot be read: {reason}; check the path and its permissions") from None
    if content is None:
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "not a regular file"
        raise InputError(f"is {kind}; name a recording saved as a file")
    if status.st_size > LARGEST_FILE:
        size, limit = status.st_size / 2**20, LARGEST_FILE / 2**20
        raise InputError(f"has {size:.0f} MB, the limit is {limit:.0f} MB; cut it into shorter recordings")
    if not content:
        raise InputError("is empty; it needs a header row and at least two samples")
    return content


def read_text_table(content: bytes, columns: ColumnMap | None, measured: bool = True) -> Table:
    """Return the table of a text file: a native FlexArm CSV, or a foreign one by its column map.

    Args:
        content: of the file.
        columns: its column map, if it is foreign.
        measured: whether it must hold a signal.

    Raises:
        InputError: naming row (line of the file, counted from 1) and column.
    """
    layout = columns or ColumnMap()
    lines = _decode(content).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    first, conditions = _preamble(lines, layout.skip_rows)
    header, body = _header(lines, first, layout)
    sources = native_sources(header) if columns is None else _places(header, layout)
    check_names(tuple(sources), measured)
    numbers = [row for row in range(body, len(lines)) if lines[row].strip()]
    if not numbers:
        raise InputError(f"has no samples after row {body}; it needs at least two rows of numbers")
    labels = {int(source.place): name for name, source in sources.items()}
    width = len(header) if columns is None else len(_cells(lines[numbers[0]], layout.delimiter))
    table = _numbers([lines[row] for row in numbers], numbers, labels, width, layout)
    values = {name: np.ascontiguousarray(table[:, i]) for i, name in enumerate(labels.values())}
    return Table(values, sources, conditions, [row + 1 for row in numbers])


def _decode(content: bytes) -> str:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"row {row}: is not UTF-8 text; save it as CSV in UTF-8") from None
    if "\0" in text:
        raise InputError("is a binary file, not text; save it as CSV in UTF-8")
    return text


def _preamble(lines: Sequence[str], skip: int) -> tuple[int, dict[str, float]]:
    """Return the number of lines before the header, and the conditions that they state."""
    conditions: dict[str, float] = {}
    for row in range(skip, len(lines)):
        line = lines[row].strip()
        if line and not line.startswith("#"):
            return row, conditions
        try:
            _add_condition(line, conditions)
        except InputError as error:
            raise InputError(f"row {row + 1}: {error}") from None
    raise InputError("has no header row; write one such as 'time [s],current [A],arm_angle [rad]'")


def _add_condition(line: str, conditions: dict[str, float]) -> None:
    """Add what a line such as `# payload = 0.3 kg` or `# payload [kg]: 0.3` states; other remarks are none of our business."""
    match = _CONDITION.fullmatch(line)
    if match is None:
        return
    name, text = match[1], f"{match[4]} {match[2] or ''}".strip()
    if match[3] == ":" and name not in CONDITIONS:
        return
    if name in conditions:
        raise InputError(f"condition '{name}' comes twice; keep one of the two")
    if name in CONDITIONS:
        conditions[name] = units.quantity(text, CONDITIONS[name])
    elif difflib.get_close_matches(name.lower(), CONDITIONS, cutoff=0.8):
        raise InputError(f"unknown condition {shown(name)}{did_you_mean(name.lower(), CONDITIONS)}")
    elif units.is_quantity(text):
        with contextlib.suppress(InputError):  # "# trial = 3 good" is a remark
            conditions[name] = units.base_value(text)


def _header(lines: Sequence[str], first: int, layout: ColumnMap) -> tuple[list[str], int]:
    """Return the header's cells ([] where a foreign file has none), and the index of the line after it."""
    mark = layout.header_prefix
    last = first
    if mark:
        if not lines[first].startswith(mark):
            raise InputError(f"row {first + 1}: no header; [columns] says that it starts with {mark!r}")
        while last + 1 < len(lines) and lines[last + 1].startswith(mark):
            last += 1
    header = _cells(lines[last].removeprefix(mark), layout.delimiter)
    if any(_is_number(cell, layout.decimal) for cell in header):
        by_index = layout.sources and all(isinstance(source.place, int) for source in layout.sources.values())
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


def _places(header: Sequence[str], layout: ColumnMap) -> dict[str, Source]:
    """Return the sources of a column map with each header text replaced by its column number."""
    if layout.matlab:
        raise InputError("is text, but [columns] names MATLAB variables; use 'column' or 'index'")
    texts = [cell.strip() for cell in header]
    sources: dict[str, Source] = {}
    for name, source in layout.sources.items():
        place = source.place
        if isinstance(place, str):
            if texts.count(place.strip()) > 1:
                raise InputError(f"column '{name}': the header has {shown(place)} twice; use 'index'")
            if place.strip() not in texts:
                raise InputError(f"column '{name}': no {shown(place)} in the header{_hint(place, texts)}")
            place = texts.index(place.strip())
        twin = next((other for other in sources if sources[other].place == place), None)
        if twin:
            raise InputError(f"columns '{twin}' and '{name}': both map to column {place}; correct one of them")
        sources[name] = Source(place, source.unit, source.sign, source.scale)
    return sources


def _hint(text: str, texts: Sequence[str]) -> str:
    if len(texts) == 1:
        return f", which is one column, {shown(texts[0])}: is the delimiter right?"
    return did_you_mean(text, [other[:40] for other in texts[:20]])


def _cells(line: str, delimiter: str) -> list[str]:
    if delimiter == " ":
        return line.split()
    try:
        return next(csv.reader([line], delimiter=delimiter), [])
    except csv.Error as error:
        raise InputError(f"{error}; is this a CSV file?") from None


def _is_number(cell: str, decimal: str) -> bool:
    """Tell whether a cell is a number as numpy's reader takes it, which refuses Python's 1_000."""
    try:
        float(_point(cell, decimal))
    except ValueError:
        return False
    return "_" not in cell and cell.isascii()


def _point(cell: str, decimal: str) -> str:
    """Return a number's text with a decimal point.

    A point in a file with decimal commas would mark thousands, so it becomes what no number has.
    """
    return cell.translate({ord("."): "'", ord(","): "."}) if decimal == "," else cell


def _numbers(rows: list[str], lines: Sequence[int], labels: dict[int, str], width: int, layout: ColumnMap) -> NDArray[np.float64]:
    """Return the (n, len(labels)) numbers of the columns in `labels`.

    Args:
        rows: the text of each sample.
        lines: the index of each in the file.
        labels: the name of each column wanted, by its 0-based number.
        width: cells that every row must have.
        layout: delimiter and decimal mark.
    """
    # numpy's reader is fast and does not say where a fault is, so Python reads again what numpy refuses.
    delimiter = layout.delimiter
    even = delimiter == " " or all(row.count(delimiter) == width - 1 for row in rows)
    if even and max(labels) < width:
        try:
            read = np.loadtxt(
                rows if layout.decimal == "." else [_point(row, layout.decimal) for row in rows],
                delimiter=None if delimiter == " " else delimiter,
                comments=None,
                quotechar='"',
                usecols=list(labels),
                ndmin=2,
            )
            if len(read) == len(rows):  # fewer where a quote that opens in one row closes in another
                return read
        except ValueError:
            pass
    return np.array(list(_slowly(rows, lines, labels, width, layout)), dtype=np.float64)


def _slowly(
    rows: list[str], lines: Sequence[int], labels: dict[int, str], width: int, layout: ColumnMap
) -> Iterator[list[float]]:
    """Yield the numbers of each row; raise InputError at the first cell that is none."""
    for name_index, name in labels.items():
        if name_index >= width:
            raise InputError(f"column '{name}': index {name_index}, but the rows have {width} cells; count from 0")
    for row, line in zip(rows, lines, strict=True):
        where = f"row {line + 1}"
        try:
            cells = _cells(row, layout.delimiter)
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        if len(cells) != width:
            hint = "write 0.5, not 0,5" if layout.delimiter == "," else "is the row cut off?"
            raise InputError(f"{where}: has {len(cells)} cells where {width} are expected; {hint}")
        for index, name in labels.items():
            if not _is_number(cells[index], layout.decimal):
                raise InputError(f"{where}, column '{name}': {_not_a_number(cells[index])}")
        yield [float(_point(cells[index], layout.decimal)) for index in labels]


def _not_a_number(cell: str) -> str:
    if not cell.strip():
        return "is empty; fill it in or remove the row"
    if _DECIMAL_COMMA.fullmatch(cell):
        return f"{shown(cell)} has a decimal comma; write {cell.strip().replace(',', '.')}"
    return f"{shown(cell)} is not a number; correct it or remove the row"
