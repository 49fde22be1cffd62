"""The entries of a `[columns]` table: where one quantity lies, and its unit, sign and scale."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import INPUTS
from flexarm_env.recordings.columns import UNITS, Source
from flexarm_env.recordings.corrections import SIGNAL_KEYS, TIME_KEYS, Corrections, read_corrections
from flexarm_env.sensors import known_sensors

PLACES: dict[str, type] = {"column": str, "index": int, "variable": str}
_CONVERSION = ("unit", "sign", "scale")
#: What is made of a condition whose numbers differ, and how its key is explained.
_OF_CHANGES = {"mean": "the mean of numbers that differ", "split": "a recording for each of its numbers"}


def listed(words: Iterable[str]) -> str:
    """Write words as "'a', 'b' and 'c'"."""
    *others, last = (f"'{word}'" for word in words)
    return f"{', '.join(others)} and {last}"


def typed(key: str, value: Any, kind: type) -> Any:
    """Check the type of a TOML value; an integer serves as a float.

    Raises:
        InputError: for a value of another type.
    """
    accepted = (int, float) if kind is float else kind
    if isinstance(value, bool) or not isinstance(value, accepted):
        words = {str: "a text", int: "a whole number", float: "a number"}
        raise InputError(f"[columns] {key}: is {value!r}; write {words[kind]}")
    return units.as_float(value) if isinstance(value, int | float) and kind is float else value


def read_sources(name: str, entry: Any) -> list[Source]:
    """Read one entry of a `[columns]` table: one source, or several whose columns are added.

    Args:
        name: of the quantity, or "conditions." and that of a condition.
        entry: the value beside it.

    Raises:
        InputError: for a key that does not exist, or a value that makes no sense.
    """
    where = f"[columns] {name}"
    if not isinstance(entry, Mapping):
        raise InputError(f"{where}: is {entry!r}; write {{column = 'header text', unit = '{_usual(name)}'}}")
    allowed = _allowed_keys(name)
    for key in entry:
        if key not in allowed:
            raise InputError(f"{where}: unknown key {key!r}{did_you_mean(str(key), allowed)}")
    if name == "time" and "rate" in entry:
        return [_even(entry)]
    if name in INPUTS and "value" in entry:
        return [_held(name, entry)]
    key = _key_of(name, entry)
    places = entry[key] if isinstance(entry.get(key), list) else [entry.get(key, name)]
    given = entry.get("unit", "" if key == "header" else None)
    unit_list = given if isinstance(given, list) else [given] * len(places)
    if len(unit_list) != len(places) or not places:
        raise InputError(f"{where}: has {len(places)} places and {len(unit_list)} units; write a unit for each")
    if len(places) > 1 and name != "time":
        raise InputError(f"{where}: is in {len(places)} columns; time alone may be, as column = ['secs', 'nsecs']")
    parts = [_part(name, key, place, unit, entry) for place, unit in zip(places, unit_list, strict=True)]
    if "time" not in entry:
        return parts
    if "file" not in entry:
        raise InputError(f"{where}: has a time of its own, but no 'file' of its own; add it, or leave the time out")
    return [replace(parts[0], time=tuple(read_sources("time", entry["time"])))]


def _allowed_keys(name: str) -> tuple[str, ...]:
    if name == "time":
        return (*PLACES, *_CONVERSION, *TIME_KEYS, "row", "rate")
    if name not in UNITS:
        return (*PLACES, *_CONVERSION, "row", *_OF_CHANGES)
    of_kind = SIGNAL_KEYS if name in known_sensors() else ("value",) if name in INPUTS else ()
    return (*PLACES, *_CONVERSION, *of_kind, "row", "file", "time")


def _usual(name: str) -> str:
    """Find the unit in SI of a quantity, that of a number for a condition."""
    return UNITS.get(name, "1")


def _key_of(name: str, entry: Mapping[str, Any]) -> str:
    """Find the key that names the place; `index` beside `variable` cuts a column out of a matrix."""
    kinds = [kind for kind in PLACES if kind in entry]
    if kinds == ["index", "variable"]:
        kinds = ["variable"]
    if len(kinds) > 1:
        raise InputError(f"[columns] {name}: give exactly one of {listed(PLACES)}")
    if not kinds and "file" in entry:
        raise InputError(f"[columns] {name}: has a file, but no place in it; add one of {listed(PLACES)}")
    if kinds != ["variable"] and "row" in entry:
        raise InputError(f"[columns] {name}: 'row' is of a 'variable' that is a matrix; leave it out")
    return kinds[0] if kinds else "header"


def _part(name: str, key: str, place: Any, unit: Any, entry: Mapping[str, Any]) -> Source:
    """Check one place of an entry, and what converts it."""
    where = f"[columns] {name}"
    if key != "header":
        place = typed(f"{name}: {key}", place, PLACES[key])
    if place == "" or (isinstance(place, int) and place < 0):
        raise InputError(f"{where}: {key} is {place!r}; columns count from 0")
    if unit is None:
        raise InputError(f"{where}: has no unit; add unit = '{_usual(name)}' or what the file has")
    unit = typed(f"{name}: unit", unit, str)
    sign, scale = entry.get("sign", 1), entry.get("scale", 1.0)
    if isinstance(sign, bool) or sign not in (1, -1):
        raise InputError(f"{where}: sign is {sign!r}; write 1 or -1, and other factors as scale")
    number, _ = units.split(scale) if isinstance(scale, str) else (typed(f"{name}: scale", scale, float), "")
    if not math.isfinite(number) or number == 0:
        raise InputError(f"{where}: scale is {scale!r}; write a number that is not zero")
    row = _number_from_zero(name, "row", entry)
    cut = _number_from_zero(name, "index", entry) if key == "variable" else None
    mean, split = (_is_wanted(name, key, entry) for key in _OF_CHANGES)
    if mean and split:
        raise InputError(f"{where}: has both {listed(_OF_CHANGES)}; keep one of the two")
    corrections = _corrections(name, entry)
    return Source(place, unit, int(sign), scale, key, row, cut, _file(name, entry), (), corrections, mean, split)


def _is_wanted(name: str, key: str, entry: Mapping[str, Any]) -> bool:
    """Read whether a key says what is made of a condition whose numbers differ."""
    value = entry.get(key, False)
    if not isinstance(value, bool):
        raise InputError(f"[columns] {name}: {key} is {value!r}; write true for {_OF_CHANGES[key]}, or leave it out")
    return value


def _corrections(name: str, entry: Mapping[str, Any]) -> Corrections:
    """Read the corrections in the entry of one column."""
    try:
        return read_corrections(entry, _usual(name))
    except InputError as error:
        raise InputError(f"[columns] {name}: {error}") from None


def _number_from_zero(name: str, key: str, entry: Mapping[str, Any]) -> int | None:
    value = typed(f"{name}: {key}", entry[key], int) if key in entry else None
    if value is not None and value < 0:
        raise InputError(f"[columns] {name}: {key} is {value}; rows and columns count from 0")
    return value


def _file(name: str, entry: Mapping[str, Any]) -> str:
    pattern: str = typed(f"{name}: file", entry.get("file", ""), str)
    if "file" in entry and (not pattern or pattern.count("*") > 1 or "/" in pattern or "\\" in pattern):
        raise InputError(f"[columns] {name}: file is {pattern!r}; write a name without folders, with one * for the run's name")
    return pattern


def _held(name: str, entry: Mapping[str, Any]) -> Source:
    """Check the value of a command that no column states, because it is the same in every row."""
    others = [key for key in entry if key != "value"]
    if others:
        raise InputError(f"[columns] {name}: has 'value' and '{others[0]}'; the value alone makes the command")
    value, unit = entry["value"], UNITS[name]
    given = value if isinstance(value, str) else typed(f"{name}: value", value, float)
    try:
        number = units.quantity(given, unit)
    except InputError as error:
        raise InputError(f"[columns] {name}: value: {error}") from None
    if not math.isfinite(number):
        raise InputError(f"[columns] {name}: value is {value!r}; write the command of every row, such as '0 {unit}'")
    return Source(number, unit, key="value")


def _even(entry: Mapping[str, Any]) -> Source:
    """Check the rate of a time that no column states."""
    others = [key for key in entry if key != "rate"]
    if others:
        raise InputError(f"[columns] time: has 'rate' and '{others[0]}'; the rate alone makes the time")
    rate = entry["rate"]
    try:
        hertz = units.quantity(rate if isinstance(rate, str) else typed("time: rate", rate, float), "Hz")
    except InputError as error:
        raise InputError(f"[columns] time: rate: {error}") from None
    if not (math.isfinite(hertz) and hertz > 0):
        raise InputError(f"[columns] time: rate is {rate!r}; write the samples per second, such as 500")
    return Source(hertz, "s", key="rate")
