"""Files to columns of raw numbers: text tables and MATLAB's .mat. Every fault is one line with its place."""

from __future__ import annotations

import contextlib
import csv
import difflib
import re
import stat
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.recordings.columns import ColumnMap, Source, check_names, native_sources

LARGEST_FILE = 256 * 2**20
CONDITIONS = {"payload": "kg", "start": "s"}

# Possessive throughout, so that no line takes time that grows faster than its length.
_CONDITION = re.compile(r"([A-Za-z_]\w*+)\s*+(?:\[([^\]]*+)\]\s*+)?([=:])\s*+(.*+)")
_STATEMENT = re.compile(r"([A-Za-z_]\w*+)\s*+(?:\[([^\]]*+)\]\s*+)?(?:(?:is|was|of|->)(?!\w)|[=:]++)?+\s*+(.*+)")
_VALUE = re.compile(r"([+-]?+(?:\d++(?:[.,]\d*+)?+|\.\d++)(?:[eE][+-]?+\d++)?+)\s*+([A-Za-zµμ]*+)(.*+)")
_DECIMAL_COMMA = re.compile(r"\s*+[+-]?+\d++,\d++\s*+")
_COMMA_AND_THREE = re.compile(r"\s*+[+-]?+[1-9]\d{0,2}+(?:,\d{3})++\s*+")


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
    numbers = [row for row in range(body, len(lines)) if not _is_blank(lines[row], layout.delimiter)]
    if not numbers:
        raise InputError(f"has no samples after row {body}; it needs at least two rows of numbers")
    labels = {int(source.place): name for name, source in sources.items()}
    rows = [lines[row] for row in numbers]
    counts = [_count(row, layout.delimiter) for row in rows]
    width = len(header) if columns is None else _usual(counts)
    if any(isinstance(source.place, str) for source in layout.sources.values()):
        _check_header(header, body, labels, width, layout.delimiter)
    even = counts.count(width) == len(rows)
    table = _numbers(rows, numbers, labels, width, even, layout)
    values = {name: np.ascontiguousarray(table[:, i]) for i, name in enumerate(labels.values())}
    return Table(values, sources, conditions, [row + 1 for row in numbers])


def read_header(head: bytes) -> list[str]:
    """Return the cells of the header of a file that begins with these bytes and has no column map.

    Raises:
        InputError: if there is no such header.
    """
    whole, _, _ = head.replace(b"\r", b"\n").rpartition(b"\n")  # the last line may be cut off, within a character, too
    lines = _decode(whole or head).split("\n")
    first, _ = _preamble(lines, 0)
    return _header(lines, first, ColumnMap())[0]


def _decode(content: bytes) -> str:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"row {row}: is not UTF-8 text; save it as CSV in UTF-8") from None
    if "\0" in text:
        raise InputError("is a binary file, not text; save it as CSV in UTF-8")
    return text


def _is_blank(line: str, delimiter: str = " ") -> bool:
    """Whether a line holds nothing but spaces and tabs, and no empty cells."""
    return not line.strip(" \t") and (delimiter == " " or delimiter not in line)


def _preamble(lines: Sequence[str], skip: int) -> tuple[int, dict[str, float]]:
    """Return the number of lines before the header, and the conditions that they state."""
    conditions: dict[str, float] = {}
    for row in range(skip, len(lines)):
        line = lines[row].strip()
        if not line.startswith("#") and not _is_blank(lines[row]):
            return row, conditions
        try:
            _add_condition(line, conditions)
        except InputError as error:
            raise InputError(f"row {row + 1}: {error}") from None
    raise InputError("has no header row; write one such as 'time [s],current [A],arm_angle [rad]'")


def _add_condition(line: str, conditions: dict[str, float]) -> None:
    """Add the condition that a line such as `# payload = 0.3 kg` or `# payload [kg]: 0.3` states; other remarks are let be."""
    text = line.lstrip("#").strip()
    match = _CONDITION.fullmatch(text)
    if match is None or (match[3] == ":" and match[1] not in CONDITIONS):
        _check_remark(text)
        return
    name, value = match[1], f"{match[4]} {match[2] or ''}".strip()
    if name in conditions:
        raise InputError(f"condition {shown(name)} comes twice; keep one of the two")
    if name in CONDITIONS:
        conditions[name] = units.quantity(value, CONDITIONS[name])
    elif difflib.get_close_matches(name.lower(), CONDITIONS, cutoff=0.8):
        raise InputError(f"unknown condition {shown(name)}{did_you_mean(name.lower(), CONDITIONS)}")
    elif units.is_quantity(value):
        with contextlib.suppress(InputError):  # "# trial = 3 good" is a remark
            conditions[name] = units.base_value(value)


def _check_remark(text: str) -> None:
    """Refuse a remark such as "payload 0.3 kg" or "tip payload: 0.3 kg", which would be lost as a condition."""
    _, _, later = text.partition(" ")
    for part in (text, later.lstrip()):
        match = _STATEMENT.fullmatch(part)
        near = match and difflib.get_close_matches(match[1].lower(), CONDITIONS, n=1, cutoff=0.8)
        value = _VALUE.fullmatch(f"{match[3]} {match[2] or ''}".strip()) if match and near else None
        if match is None or not near or value is None:
            continue
        name, number, unit, rest = near[0], value[1].replace(",", "."), value[2], value[3]
        bare = not unit and not rest.strip() and match[1].lower() == name
        if bare or (unit and len(unit) < 10 and _measures(unit, CONDITIONS[name])):
            raise InputError(f"{shown(part)} is a remark; did you mean '# {name} = {number} {unit or CONDITIONS[name]}'?")


def _measures(unit: str, target: str) -> bool:
    try:
        return units.converts(unit, target)
    except InputError:
        return False


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
        if '"' not in line:
            return line.split()
        line = " ".join(line.split())
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


def _numbers(
    rows: list[str], lines: Sequence[int], labels: dict[int, str], width: int, even: bool, layout: ColumnMap
) -> NDArray[np.float64]:
    """Return the (n, len(labels)) numbers of the columns in `labels`.

    Args:
        rows: the text of each sample.
        lines: the index of each in the file.
        labels: the name of each column wanted, by its 0-based number.
        width: cells that every row must have.
        even: whether every row has.
        layout: delimiter and decimal mark.
    """
    # numpy's reader is fast, does not say where a fault is, and checks no width: Python reads again what is not plain.
    delimiter = layout.delimiter
    plain = delimiter != " " or not any('"' in row for row in rows)
    if plain and even and max(labels) < width:
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


def _count(row: str, delimiter: str) -> int:
    """Count the cells of a row; 0 if it cannot be cut into cells."""
    if '"' not in row:
        return len(row.split()) if delimiter == " " else row.count(delimiter) + 1
    try:
        return len(_cells(row, delimiter))
    except InputError:
        return 0


def _usual(counts: Sequence[int]) -> int:
    """Return the number of cells that most rows have; of two that are as frequent, the larger."""
    often = Counter(counts)
    return max(often, key=lambda count: (often[count], count))


def _check_header(header: Sequence[str], row: int, labels: dict[int, str], width: int, delimiter: str) -> None:
    """Refuse a header by whose cells columns cannot be counted. Empty ones may end it, and nameless columns the rows."""
    named = len(header)
    while named and not header[named - 1].strip():
        named -= 1
    if named > width or (named < width and delimiter == " "):
        beyond = next((f", none for '{name}'" for index, name in labels.items() if index >= width), "")
        hint = "is there a blank in a name? give 'index' in place of 'column'" if delimiter == " " else "is the delimiter right?"
        raise InputError(f"row {row}: the header has {named} names, the rows have {width} cells{beyond}; {hint}")


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
            hint = _width_hint(row, len(cells), width, layout.delimiter)
            raise InputError(f"{where}: has {len(cells)} cells where {width} are expected; {hint}")
        for index, name in labels.items():
            if not _is_number(cells[index], layout.decimal):
                raise InputError(f"{where}, column '{name}': {_not_a_number(cells[index])}")
        yield [float(_point(cells[index], layout.decimal)) for index in labels]


def _width_hint(row: str, found: int, expected: int, delimiter: str) -> str:
    if row.lstrip().startswith("#"):
        return "a remark stands before the header; move it there or remove it"
    if found < expected:
        return "is the row cut off?"
    commas = " Or decimal commas: write 0.5, not 0,5" if delimiter == "," else ""
    return f"are two rows run together, or does the header lack a name?{commas}"


def _not_a_number(cell: str) -> str:
    if not cell.strip():
        return "is empty; a number made up would spoil the comparison: remove the row, or the column"
    if _COMMA_AND_THREE.fullmatch(cell):
        whole = cell.strip().replace(",", "")
        return f"{shown(cell)} has a comma, which may mark thousands or decimals; write {shown(whole)[1:-1]} or a decimal point"
    if _DECIMAL_COMMA.fullmatch(cell):
        return f"{shown(cell)} has a decimal comma; write {shown(cell.strip().replace(',', '.'))[1:-1]}"
    return f"{shown(cell)} is not a number; correct it or remove the row"
