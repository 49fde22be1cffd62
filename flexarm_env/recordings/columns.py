"""Which column of a file is which signal: the native header, and `[columns]` tables for foreign files."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.files import read_toml
from flexarm_env.parameters import INPUTS
from flexarm_env.sensors import known_sensors

UNITS = {"time": "s", **INPUTS, **{name: sensor.unit for name, sensor in known_sensors().items()}, "reference": "rad"}
CALIBRATED = tuple(name for name in (*known_sensors(), "reference") if UNITS[name] != "V")

_SETTINGS: dict[str, type] = {"delimiter": str, "header_prefix": str, "skip_rows": int, "decimal": str}
_PLACES: dict[str, type] = {"column": str, "index": int, "variable": str}
_NATIVE = re.compile(r"([^\[]*+)\[([^\]]*+)\]")


@dataclass(frozen=True)
class Source:
    """Where one quantity is found, and what makes it SI: value × sign × scale, in `unit`.

    Attributes:
        place: header text, 0-based column number, or name of a MATLAB variable.
        unit: unit of the numbers in the file.
        sign: 1 or -1.
        scale: a plain factor, or a quantity such as "1 rad/m".
        key: of the entry that names the place: "column", "index" or "variable".
    """

    place: str | int
    unit: str
    sign: int = 1
    scale: str | float = 1.0
    key: str = "index"


@dataclass(frozen=True)
class ColumnMap:
    """How a foreign file is laid out.

    Attributes:
        sources: by FlexArm name, where it is found.
        delimiter: one character; a blank stands for any run of blanks.
        header_prefix: the header is the last of the leading lines that start with it; "" if it has no mark.
        skip_rows: lines to drop at the top.
        decimal: "." or ",".
    """

    sources: dict[str, Source] = field(default_factory=dict)
    delimiter: str = ","
    header_prefix: str = ""
    skip_rows: int = 0
    decimal: str = "."


def check_names(names: Sequence[str], measured: bool = True) -> str:
    """Return the input ("current" or "voltage") of a recording that has these columns.

    Args:
        names: of the columns.
        measured: whether there must be a signal.

    Raises:
        InputError: if time or every signal is missing, or there is not exactly one input.
    """
    if "time" not in names:
        raise InputError("has no time column; add 'time [s]'")
    inputs = [name for name in INPUTS if name in names]
    if not inputs:
        raise InputError("has neither 'current [A]' nor 'voltage [V]'; add the input that the arm got")
    if len(inputs) > 1:
        raise InputError("has both current and voltage; keep the one that the drive was commanded with")
    if measured and not any(name in names for name in known_sensors()):
        raise InputError(f"has no measured signal; add at least one of {', '.join(known_sensors())}")
    return inputs[0]


def native_sources(header: Sequence[str]) -> dict[str, Source]:
    """Return the sources that a FlexArm header such as ["time [s]", "current [mA]", …] states.

    Raises:
        InputError: for a column without a bracketed unit, of an unknown name, or that comes twice.
    """
    sources: dict[str, Source] = {}
    for index, cell in enumerate(header):
        match = _NATIVE.fullmatch(cell.strip())
        name = match[1].strip() if match else re.split(r"[\s(\[]", cell.strip(), maxsplit=1)[0]
        where = f"column {index + 1} of the header"
        if name not in UNITS:
            raise InputError(f"{where}: unknown column {name[:60]!r}{did_you_mean(name, UNITS)}")
        unit = match[2].strip() if match else ""
        if not unit:
            raise InputError(f"{where}: '{name}' has no unit in brackets; write '{name} [{UNITS[name]}]'")
        if name in sources:
            raise InputError(f"{where}: '{name}' comes twice; keep one of the two")
        sources[name] = Source(index, unit)
    return sources


def si_factor(name: str, source: Source, calibration: Mapping[str, float]) -> float:
    """Return what a number of the file is multiplied by to be SI.

    Args:
        name: the FlexArm name.
        source: unit, sign and scale of the numbers.
        calibration: SI per volt, by signal; used for columns in volts that measure something else.

    Raises:
        InputError: for a unit that does not exist or does not convert, or volts without a calibration.
    """
    unit = UNITS[name]
    in_volts = name in CALIBRATED and _in_volts(source)
    if in_volts and name not in calibration:
        raise InputError(
            f"column '{name}' is in {source.unit}, and no sensor gain says how many {unit} a volt is;"
            f" give '{name}' a calibration in {unit}/V, or record it in {unit}"
        )
    try:
        if in_volts:
            return source.sign * units.factor(source.unit, "V", source.scale) * calibration[name]
        return source.sign * units.factor(source.unit, unit, source.scale)
    except InputError as error:
        raise InputError(f"column '{name}': {error}") from None


def _in_volts(source: Source) -> bool:
    """Tell whether the numbers are volts that no scale turns into something else."""
    if source.unit in UNITS.values() or isinstance(source.scale, str):
        return source.unit == "V" and not isinstance(source.scale, str)
    try:
        return units.converts(source.unit, "V")
    except InputError:
        return False


def check_calibration(calibration: Mapping[str, float]) -> None:
    """Raise InputError unless every entry is a finite gain, not zero, of a signal that may come in volts."""
    for name, gain in calibration.items():
        if name not in CALIBRATED:
            raise InputError(f"calibration: unknown signal {name!r}{did_you_mean(str(name), CALIBRATED)}")
        if not math.isfinite(gain) or gain == 0:
            raise InputError(f"calibration: '{name}' is {gain}; give its {UNITS[name]} per volt")


def load_columns(columns: str | os.PathLike[str] | Mapping[str, Any] | ColumnMap, measured: bool = True) -> ColumnMap:
    """Return the column map of a TOML file with a `[columns]` table, or of such a table as a dict.

    Each FlexArm name holds `column` (header text), `index` (0-based) or `variable` (MATLAB), with `unit`,
    and `sign` or `scale` if needed; beside them stand `delimiter`, `header_prefix`, `skip_rows`, `decimal`.

    Args:
        columns: the file, or the table.
        measured: whether it must map a signal.

    Raises:
        InputError: for a file that cannot be read, a key that does not exist, or a value that makes no sense.
    """
    if isinstance(columns, ColumnMap):
        return columns
    if isinstance(columns, Mapping):
        return _column_map(columns, measured)
    path = Path(columns)
    table = read_toml(path).get("columns")
    if not isinstance(table, dict):
        raise InputError(f"{path}: has no [columns] table; put the map under a line [columns]")
    try:
        return _column_map(table, measured)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _column_map(table: Mapping[str, Any], measured: bool) -> ColumnMap:
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
        check_names(tuple(sources), measured)
    except InputError as error:
        raise InputError(f"[columns] {error}") from None
    return ColumnMap(sources, **settings)


def _check_settings(settings: Mapping[str, Any]) -> None:
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
    allowed = (*_PLACES, "unit", "sign", "scale")
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
    return Source(place, unit, int(sign), scale, kinds[0])


def _typed(key: str, value: Any, kind: type) -> Any:
    """Return a TOML value of the type expected; an integer serves as a float."""
    accepted = (int, float) if kind is float else kind
    if isinstance(value, bool) or not isinstance(value, accepted):
        words = {str: "a text", int: "a whole number", float: "a number"}
        raise InputError(f"[columns] {key}: is {value!r}; write {words[kind]}")
    return units.as_float(value) if isinstance(value, int | float) and kind is float else value
