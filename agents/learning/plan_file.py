"""Plans as TOML files: read, checked and listed."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from agents.learning.options import Plan
from flexarm_env.errors import InputError
from flexarm_env.wrappers.options import read_options

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
