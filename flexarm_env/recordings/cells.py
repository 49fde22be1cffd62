"""Rows of text cut into cells, and the numbers in them. A fault is one line with its row and column."""

from __future__ import annotations

import csv
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import ColumnMap, may_be_absent
from flexarm_env.recordings.messages import quoted

#: Cells of a line: no logger has as many columns.
MOST_CELLS = 100_000

# Possessive, so that no cell takes time that grows faster than its length.
_DECIMAL_COMMA = re.compile(r"\s*+[+-]?+\d++,\d++\s*+")
_COMMA_AND_THREE = re.compile(r"\s*+[+-]?+[1-9]\d{0,2}+(?>(?:,\d{3})+)\s*+")
#: Of a condition, such as whether the torque of a servo is enabled.
_TRUTH = {"true": "1", "false": "0"}
#: Blanks and tabs part cells; a thin or a hard blank, which marks thousands, does not, though Python splits there.
_WORD = re.compile(r"[^ \t]+")
#: A row in which numpy's reader parts cells by blanks as `_WORD` does, and which has no quotes.
_PLAIN = re.compile(r"[\t !#-~]*+")
_DATE = re.compile(r"\s*+\d{1,2}[/.-]\d{1,2}[/.-]\d{2,4}[T ]")


def is_blank(line: str, delimiter: str = " ") -> bool:
    """Whether a line holds nothing but spaces and tabs, and no empty cells."""
    return not line.strip(" \t") and (delimiter == " " or delimiter not in line)


def cut(line: str, delimiter: str) -> list[str]:
    """Cut a line into cells; a delimiter of one blank stands for any run of blanks.

    Raises:
        InputError: for a cell that no CSV file has.
    """
    if line.count(delimiter) > MOST_CELLS:
        raise InputError(f"has {line.count(delimiter)} {delimiter!r}, the limit is {MOST_CELLS} cells; is this a table?")
    if delimiter == " ":
        if '"' not in line:
            return _WORD.findall(line)
        line = " ".join(_WORD.findall(line))
    try:
        return next(csv.reader([line], delimiter=delimiter), [])
    except csv.Error as error:
        raise InputError(f"{error}; is this a CSV file?") from None


def count_cells(row: str, delimiter: str) -> int:
    """Count the cells of a row; 0 if it cannot be cut."""
    if '"' not in row:
        return len(_WORD.findall(row)) if delimiter == " " else row.count(delimiter) + 1
    try:
        return len(cut(row, delimiter))
    except InputError:
        return 0


def usual_width(counts: Sequence[int]) -> int:
    """Find the number of cells that most rows have; of two that are as frequent, the larger."""
    often = Counter(counts)
    return max(often, key=lambda count: (often[count], count))


def is_number(cell: str, decimal: str) -> bool:
    """Whether a cell is a number as numpy's reader takes it, which refuses Python's 1_000."""
    try:
        float(_point(cell, decimal))
    except ValueError:
        return False
    return "_" not in cell and cell.isascii()


def _point(cell: str, decimal: str) -> str:
    """Write a number with a decimal point.

    A point in a file with decimal commas would mark thousands, so it becomes a character that no number has.
    """
    return cell.translate({ord("."): "'", ord(","): "."}) if decimal == "," else cell


def read_numbers(
    rows: list[str], lines: Sequence[int], labels: dict[int, str], width: int, even: bool, layout: ColumnMap
) -> NDArray[np.float64]:
    """Read the (n, len(labels)) numbers of the columns in `labels`; NaN for an empty cell of a signal or command.

    Args:
        rows: the text of each sample.
        lines: the index of each in the file.
        labels: the name of each column wanted, by its 0-based number.
        width: cells that every row must have.
        even: whether every row has as many.
        layout: delimiter and decimal mark.

    Raises:
        InputError: for the first row of another width, or the first cell that is no number.
    """
    # numpy's reader is fast, but locates no fault and checks no width: Python reads again any rows that are not plain.
    delimiter = layout.delimiter
    plain = delimiter != " " or all(map(_PLAIN.fullmatch, rows))
    if plain and even and max(labels) < width:
        texts = rows if layout.decimal == "." else [_point(row, layout.decimal) for row in rows]
        read = _quickly(texts, delimiter, list(labels))
        if read is None:
            read = _quickly(_filled(texts, delimiter), delimiter, list(labels))
        needed = [i for i, name in enumerate(labels.values()) if not may_be_absent(name)]
        if read is not None and not np.isnan(read[:, needed]).any():
            return read
    return np.array(list(_row_by_row(rows, lines, labels, width, layout)), dtype=np.float64)


def _quickly(rows: list[str], delimiter: str, places: list[int]) -> NDArray[np.float64] | None:
    """Read the numbers of columns by numpy's reader; None where it fails."""
    try:
        read = np.loadtxt(
            rows,
            delimiter=None if delimiter == " " else delimiter,
            comments=None,
            quotechar='"',
            usecols=places,
            ndmin=2,
        )
    except ValueError:
        return None
    return read if len(read) == len(rows) else None  # fewer where a quote that opens in one row closes in another


def _filled(rows: list[str], delimiter: str) -> list[str]:
    """Write "nan" into the empty cells of rows."""
    if delimiter == " ":
        return [re.sub(r"(?<!\S)NA(?!\S)", "nan", row) for row in rows]
    blank = "[ \t]" if delimiter != "\t" else " "
    end = re.escape(delimiter)
    empty = re.compile(rf"(?:^|(?<={end})){blank}*+(?>(?:NA{blank}*+)?)(?={end}|$)")
    return [empty.sub("nan", row) for row in rows]


def _is_absent(cell: str) -> bool:
    """Whether a cell holds nothing; "NaN" is a number."""
    return cell.strip(" \t") in ("", "NA")


def _row_by_row(
    rows: list[str], lines: Sequence[int], labels: dict[int, str], width: int, layout: ColumnMap
) -> Iterator[list[float]]:
    """Yield the numbers of each row; raise InputError at the first fault."""
    for index, name in labels.items():
        if index >= width:
            row, line = next(one for one in zip(rows, lines, strict=True) if count_cells(one[0], layout.delimiter) == width)
            raise InputError(
                f"row {line + 1}, column '{name}': index {index}, but the rows have {width} cells, as {quoted(row)}; count from 0"
            )
    for row, line in zip(rows, lines, strict=True):
        where = f"row {line + 1}"
        try:
            cells = cut(row, layout.delimiter)
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        if len(cells) != width:
            hint = _width_hint(row, len(cells), width, layout.delimiter)
            raise InputError(f"{where}: has {len(cells)} cells where {width} are expected; {hint}")
        for index, name in labels.items():
            if name in layout.conditions:
                cells[index] = _TRUTH.get(cells[index].strip().lower(), cells[index])
            absent = may_be_absent(name) and _is_absent(cells[index])
            if not absent and not is_number(cells[index], layout.decimal):
                raise InputError(f"{where}, column '{name}': {_not_a_number(cells[index], may_be_absent(name))}")
        yield [math.nan if _is_absent(cell) else float(_point(cell, layout.decimal)) for cell in map(cells.__getitem__, labels)]


def _width_hint(row: str, found: int, expected: int, delimiter: str) -> str:
    stands = f"it is {quoted(row)}"
    if row.lstrip().startswith("#"):
        return f"a remark stands before the header or after the last row; {stands}"
    if found < expected:
        return f"is the row cut off? {stands}"
    commas = " Or are its commas decimal ones? Export with decimal points, or with ';' between cells" if delimiter == "," else ""
    return f"are two rows run together, or does the header lack a name? {stands}.{commas}"


def _not_a_number(cell: str, may_be_absent: bool) -> str:
    if not cell.strip():
        return "is empty; a replay needs time and reference in every row; only signals and later commands may be absent"
    if _COMMA_AND_THREE.fullmatch(cell):
        return (
            f"{quoted(cell)} has a comma, which may mark thousands or decimals;"
            " export without marks of thousands, or say decimal = ',' in [columns] if it is the decimal mark"
        )
    if _DECIMAL_COMMA.fullmatch(cell):
        return f"{quoted(cell)} has a decimal comma; say decimal = ',' in [columns], or export with decimal points"
    if _DATE.match(cell):
        return f"{quoted(cell)} is a date whose day and month may be read two ways; export it as 2024-05-31 10:00:00.5"
    empty = ", or leave the cell empty if nothing was measured" if may_be_absent else ""
    return f"{quoted(cell)} is not a number; correct it{empty}"
