"""Column maps: the `[columns]` table of an arm file or of a file of its own."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from flexarm_env.control.law import ControlLaw
from flexarm_env.control.table import law_from_table
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.files import read_toml
from flexarm_env.parameters import INPUTS
from flexarm_env.recordings.checks import check_conditions
from flexarm_env.recordings.column_entries import PLACES, listed, read_sources, typed
from flexarm_env.recordings.columns import MADE, UNITS, ColumnMap, Source, check_names, part_names
from flexarm_env.recordings.messages import file_error

_SETTINGS: dict[str, type] = {"delimiter": str, "header_prefix": str, "skip_rows": int, "decimal": str}
_OTHERS = (*_SETTINGS, "conditions", "episode_index")
#: Tables of a file of a map, and the one by which a file is an arm's, which has others.
_TABLES, _OF_AN_ARM = ("columns", "controller"), "drive"


def load_columns(columns: str | os.PathLike[str] | Mapping[str, Any] | ColumnMap) -> ColumnMap:
    """Load a column map from a TOML file with a `[columns]` table, or from such a table as a dict.

    Each FlexArm name holds `column` (header text), `index` (0-based) or `variable` (a path such as "data.signals(2).values",
    with `row` or `index` of a matrix), with `unit`, and `sign` or `scale` if needed; `file` names another file that has it.
    Entries that all lack a place refine FlexArm's own header. A signal also has `ignore`, `range`, `repeats`, `wrap` and
    `shift`, time `shift`; a command that is the same in every row has a `value` alone. Beside them stand `delimiter`,
    `header_prefix`, `skip_rows`, `decimal`, and a table `conditions` of columns that hold one number each, such as a gain, and
    `episode_index`, the number or numbers of those that are read of a file with several. A file may have a `[controller]`
    table, too.

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
    tables = read_toml(path)
    table = tables.get("columns")
    if not isinstance(table, dict):
        raise InputError(f"{path}: has no [columns] table; put the map under a line [columns]")
    try:
        check_tables(tables)
        layout = _column_map(table)
        return replace(layout, controller=_law(tables["controller"], layout)) if "controller" in tables else layout
    except InputError as error:
        raise file_error(path, error) from None


def check_tables(tables: Mapping[str, Any]) -> None:
    """Refuse what stands beside the `[columns]` of a file and would be read as nothing; an arm file has tables of its own.

    Raises:
        InputError: for a key that such a file does not have.
    """
    if _OF_AN_ARM in tables:
        return
    if "conditions" in tables:
        raise InputError(
            "has [conditions] beside [columns], which is read for no recording; write run.toml beside run.csv with"
            " [conditions] alone, or columns of conditions under [columns.conditions]"
        )
    for key in tables:
        if key not in _TABLES:
            where = f"; write it under the line [columns], in which {key!r} stands" if key in (*UNITS, *_OTHERS) else ""
            raise InputError(f"unknown key {key!r} beside [columns]{where or did_you_mean(str(key), _TABLES)}")


def _column_map(table: Mapping[str, Any]) -> ColumnMap:
    """Check a `[columns]` table."""
    sources: dict[str, Source] = {}
    for key, value in table.items():
        if key in UNITS:
            parts = read_sources(key, value)
            sources |= dict(zip(part_names(key, len(parts)), parts, strict=True))
        elif key not in _OTHERS:
            raise InputError(f"[columns]: unknown key {key!r}{did_you_mean(str(key), (*UNITS, *_OTHERS))}")
    settings = {key: typed(key, table[key], _SETTINGS[key]) for key in _SETTINGS if key in table}
    _check_settings(settings)
    conditions = _conditions(table.get("conditions", {}))
    columns = ColumnMap(sources, **settings, conditions=conditions, episodes=_episodes(table.get("episode_index", [])))
    _check_kinds(columns)
    if not (table and columns.refines):
        try:
            check_names(tuple(sources))
        except InputError as error:
            raise InputError(f"[columns] {error}") from None
    return columns


def _episodes(value: Any) -> tuple[int, ...]:
    """Check the numbers of the episodes that are read."""
    numbers = value if isinstance(value, list) else [value]
    if any(isinstance(one, bool) or not isinstance(one, int) or one < 0 for one in numbers) or len(set(numbers)) < len(numbers):
        raise InputError(f"[columns] episode_index: is {value!r}; write the number of an episode, such as 3, or a list")
    return tuple(numbers)


def _check_kinds(columns: ColumnMap) -> None:
    """Refuse entries that cannot be of one file."""
    if columns.refines and columns.conditions:
        raise InputError("[columns]: has conditions in columns, so name the places of the others, too")
    for name, source in columns.conditions.items():
        if source.split and columns.joins:
            raise InputError(f"[columns] conditions.{name}: split is of a run in one file; leave it out, or write mean = true")
    if columns.joins and columns.episodes:
        raise InputError("[columns]: has episode_index, which is of one file of episodes, and 'file'; keep one of the two")
    by_file: dict[str, set[str]] = {}
    for name, source in (columns.sources | columns.conditions).items():
        if source.key == "header" and not columns.refines:
            raise InputError(f"[columns] {name}: give exactly one of {listed(PLACES)}, as the other entries do")
        if source.key not in MADE and not (name.startswith("time") and columns.joins):
            by_file.setdefault(source.file, set()).add("variable" if source.key == "variable" else "column")
    if not columns.joins and any(len(kinds) > 1 for kinds in by_file.values()):
        raise InputError("[columns]: some entries have 'variable' and some 'column' or 'index'; keep to one kind")


def _conditions(table: Any) -> dict[str, Source]:
    """Check the sources of conditions."""
    if not isinstance(table, Mapping):
        raise InputError("[columns] conditions: is not a table; write it under a line [columns.conditions]")
    for name in table:
        if name in UNITS:
            raise InputError(f"[columns.conditions]: {name!r} is a column; give the condition another name")
        check_conditions({str(name): 0.0})
    return {str(name): read_sources(f"conditions.{name}", entry)[0] for name, entry in table.items()}


def _law(table: Any, layout: ColumnMap) -> ControlLaw:
    """Read the `[controller]` table beside a column map."""
    kind = next((kind for kind in INPUTS if kind in layout.sources), None)
    if kind is None:
        raise InputError("[controller] has a command that [columns] does not name; add current = {} or voltage = {} there")
    law = law_from_table(table, kind)
    for signal in law.signals:
        if signal not in layout.sources:
            raise InputError(f"controller.{signal} feeds back a signal that [columns] does not name; add it there")
    return law


def _check_settings(settings: Mapping[str, Any]) -> None:
    """Check the entries that describe the file rather than a column."""
    delimiter, decimal = settings.get("delimiter", ","), settings.get("decimal", ".")
    if len(delimiter) != 1 or delimiter in '\r\n"#+-.eE0123456789':
        raise InputError(f"[columns]: delimiter is {delimiter!r}; write one character, such as ',' ';' or '\\t'")
    if decimal not in (".", ","):
        raise InputError(f"[columns]: decimal is {decimal!r}; write '.' or ','")
    if decimal == delimiter and "delimiter" in settings:  # without one the file's first line may still give it
        raise InputError("[columns]: decimal and delimiter are both ','; set delimiter = ';' or what the file has")
    if settings.get("skip_rows", 0) < 0:
        raise InputError("[columns]: skip_rows is negative; write the number of lines to drop")
