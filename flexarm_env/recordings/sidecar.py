"""Conditions of a recording in a file beside it: `run.toml` for `run.csv`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.files import read_toml
from flexarm_env.recordings.checks import check_conditions
from flexarm_env.recordings.column_maps import check_tables
from flexarm_env.recordings.columns import ColumnMap
from flexarm_env.recordings.conditions import CONDITIONS, unit_of
from flexarm_env.recordings.joined import files_of_recording, recording_name
from flexarm_env.recordings.messages import file_error

TABLE = "conditions"
#: Tables of arm files and column maps, which may lie beside a recording under the same name.
_OTHERS = ("drive", "columns", "hub", "sensors")


def conditions_beside(
    path: Path, columns: ColumnMap | None, given: Mapping[str, float]
) -> tuple[dict[str, float], tuple[str, ...]]:
    """Read the conditions in the files beside a recording, and notes that name them; none where there are none.

    Args:
        path: of the recording, that with the command where it is in several files.
        columns: its column map, if there is one.
        given: conditions that its own files state.

    Raises:
        InputError: for a faulty file beside it, for a condition that its own file states, too, and for two that differ.
    """
    found: dict[str, float] = {}
    notes = []
    for beside in sidecars_of(path, columns):
        stated = read_conditions(beside)
        for name, value in stated.items():
            if name in given:
                raise file_error(path, f"condition '{name}' comes twice, in the file and in {beside.name}; keep one of the two")
            if found.get(name, value) != value:
                other = f"{found[name]:g} in another file beside the recording"
                raise file_error(beside, f"condition '{name}' is {value:g}, but {other}; correct one")
        found |= stated
        listed = ", ".join(f"{name} = {value:g} {unit_of(name, value)}".rstrip() for name, value in stated.items())
        notes += [f"{beside.name} states {listed}"] if stated else []
    return found, tuple(notes)


def sidecars_of(path: Path, columns: ColumnMap | None) -> list[Path]:
    """List the files of conditions beside a recording, which have its name or that of one of its files.

    Args:
        path: of the recording, that with the command where it is in several files.
        columns: its column map, if there is one.

    Raises:
        InputError: for a file of such a name that has neither conditions nor an arm nor a column map.
    """
    files = files_of_recording(path, columns)
    places = [path.with_name(f"{recording_name(path, columns)}.toml"), *(file.with_suffix(".toml") for file in files)]
    return [place for place in dict.fromkeys(places) if place not in files and _states_conditions(place, path)]


def _states_conditions(beside: Path, path: Path) -> bool:
    """Whether there is a file of conditions beside a recording."""
    if beside.is_dir() or not os.path.lexists(beside):  # a link to nowhere is no absence
        return False
    table = read_toml(beside)
    if any(key in table for key in _OTHERS):
        _check_map(beside, table)
        return False
    if TABLE not in table:
        raise file_error(beside, f"has no [{TABLE}] table for {path.name} beside it; write conditions under a line [{TABLE}]")
    return True


def _check_map(beside: Path, table: Mapping[str, Any]) -> None:
    """Refuse a column map beside a recording that hides conditions."""
    try:
        if TABLE in table and "columns" in table:
            check_tables(table)
    except InputError as error:
        raise file_error(beside, error) from None


def read_conditions(path: Path) -> dict[str, float]:
    """Read the conditions that a file beside a recording states, in SI; true and false are 1 and 0.

    Args:
        path: of the TOML file, with a table `[conditions]`.

    Raises:
        InputError: for a condition that is no number with or without a unit.
    """
    table = read_toml(path)
    conditions = table[TABLE]
    try:
        _check_tables(table, conditions)
        found = {str(name): _in_si(str(name), value) for name, value in conditions.items()}
        check_conditions(found)
    except InputError as error:
        raise file_error(path, error) from None
    return found


def _check_tables(table: Mapping[str, Any], conditions: Any) -> None:
    others = [key for key in table if key != TABLE]
    if others or not isinstance(conditions, Mapping):
        what = f"has {others[0]!r} beside it" if others else "is not a table"
        raise InputError(f"[{TABLE}] {what}; write conditions alone, such as payload = '0.3 kg', under a line [{TABLE}]")


def _in_si(name: str, value: Any) -> float:
    known = name in CONDITIONS
    if not isinstance(value, str | int | float) or (known and isinstance(value, bool)):
        allowed = "a number, a quantity such as '0.3 kg', true or false"
        raise InputError(f"condition '{name}' is {value!r}; write {f'a number in {CONDITIONS[name]}' if known else allowed}")
    try:
        if known:
            return units.quantity(value, CONDITIONS[name])
        return units.base_value(value) if isinstance(value, str) else units.as_float(value)
    except InputError as error:
        raise InputError(f"condition '{name}': {error}") from None
