"""Dates with times, and times of day, in the cells of a text table, as ISO 8601 writes them."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError
from flexarm_env.recordings.cells import cut
from flexarm_env.recordings.columns import Source
from flexarm_env.recordings.messages import quoted

# Possessive, so that no cell takes time that grows faster than its length.
_STAMP = re.compile(r"(\d{4}-\d\d-\d\d)[T ](\d\d:\d\d(?>(?::\d\d(?>(?:[.,]\d{1,9}+)?))?))[ ]?+(?>(Z|[+-]\d\d:?\d\d)?)")
_OF_DAY = re.compile(r"\d\d:\d\d:\d\d(?>(?:[.,]\d{1,9}+)?)")
_HALF_A_DAY, _DAY = np.timedelta64(12, "h"), np.timedelta64(24, "h")


def is_stamp(cell: str) -> bool:
    """Whether a cell is a date with a time, or a time of day with seconds.

    Example:
        >>> is_stamp("2024-05-01 10:00:00.25"), is_stamp("10:00:00.25"), is_stamp("0.25")
        (True, True, False)
    """
    return any(form.fullmatch(cell.strip()) for form in (_STAMP, _OF_DAY))


def check_unscaled(name: str, source: Source) -> None:
    """Refuse a factor of a column of dates, times of day or durations, which have a unit of their own.

    Raises:
        InputError: for such a factor.
    """
    if source.scale != 1.0:
        raise InputError(f"column '{name}': scale is {source.scale!r}, but its times have a unit of their own; leave scale out")


def read_stamps(rows: Sequence[str], lines: Sequence[int], place: int, delimiter: str) -> NDArray[np.float64]:
    """Read the times (n,) [s] of a column of dates with times, or of times of day, from the first of them.

    A time of day that falls by more than half a day has passed midnight.

    Args:
        rows: the text of each sample.
        lines: the index of each in the file.
        place: 0-based number of the column.
        delimiter: between cells.

    Raises:
        InputError: for a cell that is no such time, or has another time zone than the first.
    """
    if _OF_DAY.fullmatch(cut(rows[0], delimiter)[place].strip()):
        return _read_times_of_day(rows, lines, place, delimiter)
    found, zones = [], set()
    for row, line in zip(rows, lines, strict=True):
        cell = cut(row, delimiter)[place].strip()
        match = _STAMP.fullmatch(cell)
        zones |= {match[3] if match else None}
        try:
            if match is None or len(zones) > 1:
                raise ValueError
            found.append(np.datetime64(f"{match[1]}T{match[2].replace(',', '.')}", "ns"))
        except ValueError:
            raise InputError(
                f"row {line + 1}, column 'time': {quoted(cell)} is no date with a time as in the first row; correct it"
            ) from None
    since = np.array(found) - found[0]
    return np.asarray(since / np.timedelta64(1, "s"), dtype=np.float64)


def _read_times_of_day(rows: Sequence[str], lines: Sequence[int], place: int, delimiter: str) -> NDArray[np.float64]:
    found = []
    for row, line in zip(rows, lines, strict=True):
        cell = cut(row, delimiter)[place].strip()
        try:
            if not _OF_DAY.fullmatch(cell):
                raise ValueError
            found.append(np.datetime64(f"1970-01-01T{cell.replace(',', '.')}", "ns"))
        except ValueError:
            raise InputError(
                f"row {line + 1}, column 'time': {quoted(cell)} is no time of day as in the first row; correct it"
            ) from None
    times = np.array(found)
    days = np.concatenate([[0], np.cumsum(np.diff(times) < -_HALF_A_DAY)])
    return np.asarray((times - times[0] + days * _DAY) / np.timedelta64(1, "s"), dtype=np.float64)
