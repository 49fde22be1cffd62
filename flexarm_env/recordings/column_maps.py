"""Column maps: the `[columns]` table of an arm file or of a file of its own."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.files import read_toml
from flexarm_env.recordings.columns import UNITS, ColumnMap, Source, check_names
from flexarm_env.recordings.corrections import SIGNAL_KEYS, TIME_KEYS, Corrections, read_corrections
from flexarm_env.sensors import known_sensors

_SETTINGS: dict[str, type] = {"delimiter": str, "header_prefix": str, "skip_rows": int, "decimal": str}
_PLACES: dict[str, type] = {"column": str, "index": int, "variable": str}


def load_columns(columns: str | os.PathLike[str] | Mapping[str, Any] | ColumnMap) -> ColumnMap:
    """Load a column map from a TOML file with a `[columns]` table, or from such a table as a dict.

    Each FlexArm name holds `column` (header text), `index` (0-based) or `variable` (MATLAB), with `unit`,
    and `sign` or `scale` if needed; a signal also `ignore`, `range`, `repeats`, `wrap` and `shift`, time `shift`.
    Beside them stand `delimiter`, `header_prefix`, `skip_rows`, `decimal`.

    Args:
        columns: the file, or the table.

    Raises:
        InputError: for a file that cannot be read, a key that does not exist, or a value that makes no sense.

    Examples:
        >>> from flexarm_env.recordings.column_maps import load_columns
        >>> table = {
        ...     "delimiter": ";",
        ...     "time": {"column": "t", "unit": "ms"},
        ...     "current": {"column": "I", "unit": "mA"},
        ...     "arm_angle": {"column": "encoder", "unit": "deg", "sign": -1},
        ... }
        >>> angle = load_columns(table).sources["arm_angle"]
        >>> angle.place, angle.unit, angle.sign
        ('encoder', 'deg', -1)
    """
    if isinstance(columns, ColumnMap):
        return columns
    if isinstance(columns, Mapping):
        return _column_map(columns)
    path = Path(columns)
    table = read_toml(path).get("columns")
    if not isinstance(table, dict):
        raise InputError(f"{path}: has no [columns] table; put the map under a line [columns]")
    try:
        return _column_map(table)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _column_map(table: Mapping[str, Any]) -> ColumnMap:
    """Check a `[columns]` table."""
    sources: dict[str, Source] = {}
    for key, value in table.items():
        if key in UNITS:
            sources[key] = _source(key, value)
        elif key not in _SETTINGS:
            raise InputError(f"[columns]: unknown key {key!r}{did_you_mean(str(key), (*UNITS, *_SETTINGS))}")
    if len({source.key == "variable" for source in sources.values()}) > 1:
        raise InputError("[columns]: some entries have 'variable' and some 'column' or 'index'; keep to one kind")
    settings = {key: _typed(key, table[key], _SETTINGS[key]) for key in _SETTINGS if key in table}
    _check_settings(settings)
    try:
        check_names(tuple(sources))
    except InputError as error:
        raise InputError(f"[columns] {error}") from None
    return ColumnMap(sources, **settings)


def _check_settings(settings: Mapping[str, Any]) -> None:
    """Check the entries that describe the file rather than a column."""
    delimiter, decimal = settings.get("delimiter", ","), settings.get("decimal", ".")
    if len(delimiter) != 1 or delimiter in '\r\n"#+-.eE0123456789':
        raise InputError(f"[columns]: delimiter is {delimiter!r}; write one character, such as ',' ';' or '\\t'")
    if decimal not in (".", ","):
        raise InputError(f"[columns]: decimal is {decimal!r}; write '.' or ','")
    if decimal == delimiter:
        raise InputError("[columns]: decimal and delimiter are both ','; set delimiter = ';' or what the file has")
    if settings.get("skip_rows", 0) < 0:
        raise InputError("[columns]: skip_rows is negative; write the number of lines to drop")


def _source(name: str, entry: Any) -> Source:
    """Check one entry of a `[columns]` table."""
    where = f"[columns] {name}"
    if not isinstance(entry, Mapping):
        raise InputError(f"{where}: is {entry!r}; write {{column = 'header text', unit = '{UNITS[name]}'}}")
    corrections = SIGNAL_KEYS if name in known_sensors() else TIME_KEYS if name == "time" else ()
    allowed = (*_PLACES, "unit", "sign", "scale", *corrections)
    for key in entry:
        if key not in allowed:
            raise InputError(f"{where}: unknown key {key!r}{did_you_mean(str(key), allowed)}")
    kinds = [kind for kind in _PLACES if kind in entry]
    if len(kinds) != 1:
        raise InputError(f"{where}: give exactly one of 'column', 'index' and 'variable'")
    place = _typed(f"{name}: {kinds[0]}", entry[kinds[0]], _PLACES[kinds[0]])
    if place == "" or (isinstance(place, int) and place < 0):
        raise InputError(f"{where}: {kinds[0]} is {place!r}; columns count from 0")
    if "unit" not in entry:
        raise InputError(f"{where}: has no unit; add unit = '{UNITS[name]}' or what the file has")
    unit = _typed(f"{name}: unit", entry["unit"], str)
    sign, scale = entry.get("sign", 1), entry.get("scale", 1.0)
    if isinstance(sign, bool) or sign not in (1, -1):
        raise InputError(f"{where}: sign is {sign!r}; write 1 or -1, and other factors as scale")
    number, _ = units.split(scale) if isinstance(scale, str) else (_typed(f"{name}: scale", scale, float), "")
    if not math.isfinite(number) or number == 0:
        raise InputError(f"{where}: scale is {scale!r}; write a number that is not zero")
    return Source(place, unit, int(sign), scale, kinds[0], _corrections(name, entry))


def _corrections(name: str, entry: Mapping[str, Any]) -> Corrections:
    """Read the corrections in the entry of one column."""
    try:
        return read_corrections(entry, UNITS[name])
    except InputError as error:
        raise InputError(f"[columns] {name}: {error}") from None


def _typed(key: str, value: Any, kind: type) -> Any:
    """Check the type of a TOML value; an integer serves as a float."""
    accepted = (int, float) if kind is float else kind
    if isinstance(value, bool) or not isinstance(value, accepted):
        words = {str: "a text", int: "a whole number", float: "a number"}
        raise InputError(f"[columns] {key}: is {value!r}; write {words[kind]}")
    return units.as_float(value) if isinstance(value, int | float) and kind is float else value
