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
from flexarm_env.recordings.conditions import CONDITIONS, unit_of
from flexarm_env.recordings.messages import file_error

TABLE = "conditions"
#: Tables of arm files and column maps, which may lie beside a recording under the same name.
_OTHERS = ("drive", "columns", "hub", "sensors")


def conditions_beside(path: Path, given: Mapping[str, float]) -> tuple[dict[str, float], tuple[str, ...]]:
    """Read the conditions in the file beside a recording, and notes that name it; none where there is none.

    Args:
        path: of the recording.
        given: conditions that its own file states.

    Raises:
        InputError: for a faulty file beside it, and for a condition that both state.
    """
    beside = sidecar_of(path)
    if beside is None:
        return {}, ()
    stated = read_conditions(beside)
    twice = [name for name in stated if name in given]
    if twice:
        raise file_error(path, f"condition '{twice[0]}' comes twice, in the file and in {beside.name}; keep one of the two")
    if not stated:
        return {}, ()
    listed = ", ".join(f"{name} = {value:g} {unit_of(name, value)}".rstrip() for name, value in stated.items())
    return stated, (f"{beside.name} states {listed}",)


def sidecar_of(path: Path) -> Path | None:
    """Find the file of conditions beside a recording; None where there is none.

    Args:
        path: of the recording.

    Raises:
        InputError: for a file of that name that has neither conditions nor an arm nor a column map.
    """
    beside = path.with_suffix(".toml")
    if beside == path or beside.is_dir() or not os.path.lexists(beside):  # a link to nowhere is no absence
        return None
    table = read_toml(beside)
    if any(key in table for key in _OTHERS):
        return None
    if TABLE not in table:
        raise file_error(beside, f"has no [{TABLE}] table for {path.name} beside it; write conditions under a line [{TABLE}]")
    return beside


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
