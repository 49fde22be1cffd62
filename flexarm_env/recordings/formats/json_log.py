"""JSON logs: a list of entries with one number of each quantity, and conditions of the run beside it."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import ColumnMap, may_be_absent
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.formats.json_text import load_json
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.table import MOST_LINES, Table

Floats = NDArray[np.float64]

# Possessive, so that no path takes time that grows faster than its length.
_PATH = re.compile(r"\w++(?>(?:\.\w++|\[\d{1,9}+\])*)")
_STEP = re.compile(r"(\w+)|\[(\d+)\]")
_MOST_SHOWN = 12
#: In the message of Python's reader on text after an object, such as another one in the next line.
_AFTER_THE_END = "Extra data"
#: Parts of a log, each of which takes many times its length in memory: a gigabyte is full of as many.
_MOST = {"objects and lists": (b"{[", 4_000_000), "values": (b",", 30_000_000)}


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of a JSON log by its column map.

    A path such as "entries.position" leads through lists to a number of each of their entries; "mass" is a single number,
    such as a condition; "q[0]" is the first element of a list.

    Args:
        content: of the file.
        columns: its column map, without which nothing is read.

    Raises:
        InputError: for content that is no JSON, and for a path that leads to no numbers.
    """
    for what, (marks, most) in _MOST.items():
        count = sum(content.count(mark) for mark in marks)
        if count > most:
            raise InputError(f"has {count} {what}, the limit is {most}; cut it into shorter recordings")
    try:
        log = load_json(content)
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        hint = "; write its objects as one list, [{…}, {…}]" if _AFTER_THE_END in str(error) else ""
        raise InputError(f"is damaged or no JSON: {quoted(str(error))}{hint}") from None
    layout = columns or ColumnMap()
    values = {name: _column(log, name, str(one.place), name in layout.conditions) for name, one in layout.sources.items()}
    return Table(values, dict(layout.sources))


def _column(log: Any, name: str, path: str, truth: bool) -> Floats:
    """Read the numbers of one quantity: NaN where it may be absent and is, 1 and 0 for true and false where they may be."""
    if _PATH.fullmatch(path) is None:
        raise InputError(f"column '{name}': {quoted(path)} is no path; write one such as 'entries.position' or 'entries.q[0]'")
    found = _follow(log, _STEP.findall(path), name, path)
    entries = found if isinstance(found, list) else [found]
    if entries and all(entry is None for entry in entries):
        raise InputError(f"column '{name}': {quoted(path)} is in none of {len(entries)} entries; name another")
    if len(entries) > MOST_LINES:
        raise InputError(f"has {len(entries)} entries, the limit is {MOST_LINES}; cut it into shorter recordings")
    return np.array([_number(entry, name, path, truth) for entry in entries], dtype=np.float64)


def _follow(value: Any, steps: Sequence[tuple[str, str]], name: str, path: str, in_entry: bool = False) -> Any:
    """Follow a path: a name behind a list in each of its elements. None where an entry lacks what may be absent."""
    for done, (field, index) in enumerate(steps):
        if field and isinstance(value, list):
            return [_follow(element, steps[done:], name, path, in_entry=True) for element in value]
        if field and isinstance(value, dict) and field in value:
            value = value[field]
        elif index and isinstance(value, list) and int(index) < len(value):
            value = value[int(index)]
        elif in_entry and may_be_absent(name) and (value is None or (field and isinstance(value, dict))):
            return None
        else:
            raise InputError(f"column '{name}': {quoted(path)} finds no {quoted(field or f'[{index}]')} in {_holds(value)}")
    return value


def _holds(value: Any) -> str:
    """Describe a part of a log by its keys, its length or its value."""
    if isinstance(value, dict):
        more = ["…"] if len(value) > _MOST_SHOWN else []
        return f"an object with {', '.join([*map(quoted, list(value)[:_MOST_SHOWN]), *more]) or 'nothing'}"
    return f"a list of {len(value)} elements, counted from 0" if isinstance(value, list) else quoted(json.dumps(value))


def _number(value: Any, name: str, path: str, truth: bool) -> float:
    """Convert an entry to a number: what is absent and may be to NaN, and true and false of a condition to 1 and 0."""
    if value is None and may_be_absent(name):
        return math.nan
    if not isinstance(value, int | float) or (isinstance(value, bool) and not truth):
        raise InputError(f"column '{name}': {quoted(path)} leads to {_holds(value)}, not to a number")
    return units.as_float(value)


FORMAT = Format("JSON log", (), ("variable",), read, also=(".json",))
