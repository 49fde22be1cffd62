"""The numbers of the method as tables, one per stage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.terminal import tables
from flexarm_env.terminal.delivery import deliver

_COLUMNS = ("name", "value", "unit", "meaning", "how found")


def show(json: Path | None) -> None:
    """Print the settings; write their values as JSON where a file is named."""
    deliver(json, SETTINGS.as_json(), _parts(SETTINGS))


def _parts(settings: Settings) -> list[RenderableType]:
    rows: dict[str, list[list[str]]] = {}
    for number in settings.numbers():
        row = [number.name, _value(number.value), number.unit, number.meaning, number.found]
        rows.setdefault(number.stage, []).append(row)
    heading = Text(f"Settings {settings.digest()}", style="bold")
    return [heading, *(tables.text_table(stage, _COLUMNS, found) for stage, found in rows.items())]


def _value(value: Any) -> str:
    return ", ".join(f"{one:g}" for one in value) if isinstance(value, tuple) else f"{value:g}"
