"""Plans as TOML files: read, checked and listed."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, TypeVar

from agents.learning.options import Plan
from flexarm_env.errors import InputError, did_you_mean

Section = TypeVar("Section")

LARGEST_FILE = 100_000


def read_plan(path: Path) -> Plan:
    """Read a TOML file.

    Raises:
        InputError: one line that names the file, the key, and how to mend it.
    """
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise InputError(f"{path} is larger than {LARGEST_FILE} bytes: that is no configuration")
        return read_table(tomllib.loads(path.read_bytes().decode("utf-8")))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path} is not TOML: {error}") from None
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}; name one such as configs/agents/ppo_slew.toml") from None


def read_table(table: Mapping[str, Any]) -> Plan:
    """Convert a table of TOML or JSON to a plan.

    Raises:
        InputError: for a key that does not exist, or a value that is none.
    """
    return _read(Plan, table, "")


def _read(section: type[Section], table: Any, prefix: str) -> Section:
    if not isinstance(table, Mapping):
        raise InputError(f"{prefix.rstrip('.')} = {table!r} is not a table; write [{prefix.rstrip('.')}]")
    known = {entry.name: entry for entry in fields(section)}  # type: ignore[arg-type]
    found = {}
    for key, value in table.items():
        if key not in known:
            raise InputError(f"unknown key '{prefix}{key}'{did_you_mean(key, known)}")
        default = getattr(section(), key)
        if is_dataclass(default):
            found[key] = _read(type(default), value, f"{prefix}{key}.")
        else:
            found[key] = _value(f"{prefix}{key}", value, default, known[key].metadata)
    return section(**found)


def _value(path: str, value: Any, default: Any, rules: Mapping[str, Any]) -> Any:
    """Convert a value to the type of its default."""
    if isinstance(default, tuple):
        if not isinstance(value, list | tuple):
            raise InputError(f"{path} = {value!r}; give a list such as {list(default)}")
        return tuple(_number(path, entry, default[0] if default else 0.0, rules) for entry in value)
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise InputError(f"{path} = {value!r}; give true or false")
        return value
    if isinstance(default, str):
        if not isinstance(value, str):
            raise InputError(f"{path} = {value!r}; give a text such as '{default}'")
        if rules["allowed"] is not None and value not in rules["allowed"]:
            raise InputError(f"{path} = '{value}'{did_you_mean(value, rules['allowed'])}")
        return value
    return _number(path, value, default, rules)


def _number(path: str, value: Any, default: float, rules: Mapping[str, Any]) -> float:
    kinds = int if isinstance(default, int) else int | float
    if isinstance(value, bool) or not isinstance(value, kinds):
        raise InputError(f"{path} = {value!r}; give a {'whole ' if kinds is int else ''}number")
    if not rules["least"] <= value <= rules["most"]:
        raise InputError(f"{path} = {value:g}; allowed are {rules['least']:g} to {rules['most']:g}")
    return type(default)(value)


def option_table() -> str:
    """List all options in Markdown: name, default, meaning."""
    lines = ["| option | default | |", "|---|---|---|"]
    for entry in fields(Plan):
        section = getattr(Plan(), entry.name)
        nested = is_dataclass(section)
        for part in fields(section) if nested else [entry]:
            prefix, owner = (f"{entry.name}.", section) if nested else ("", Plan())
            default = getattr(owner, part.name)
            shown = json.dumps(default) if isinstance(default, bool | tuple) else default
            lines.append(f"| `{prefix}{part.name}` | `{shown}` | {part.metadata['meaning']} |")
    return "\n".join(lines) + "\n"
