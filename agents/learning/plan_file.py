"""Plans as TOML files: read, checked and listed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from agents.learning.options import Plan
from flexarm_env.errors import InputError
from flexarm_env.files import read_toml
from flexarm_env.wrappers.options import read_options


def read_plan(path: Path) -> Plan:
    """Read a TOML file.

    Raises:
        InputError: one line that names the file, the key, and how to mend it.
    """
    table = read_toml(path, "name one such as configs/agents/ppo_slew.toml")
    try:
        return read_table(table)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def read_table(table: Mapping[str, Any]) -> Plan:
    """Convert a table of TOML or JSON to a plan.

    Raises:
        InputError: for a key that does not exist, or a value that is none.
    """
    return read_options(Plan, table)


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
