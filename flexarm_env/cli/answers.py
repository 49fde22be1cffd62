"""The answer of a command: tables for a person, JSON for a program, an arm file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import RenderableType

from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal import outputs, tables
from flexarm_env.terminal.provenance import provenance


def hand_out(
    command: str,
    arm: str,
    recordings: Sequence[Recording],
    seed: int | None,
    json: Path | None,
    content: dict[str, Any],
    parts: Sequence[RenderableType],
) -> None:
    """Print tables, to stderr if stdout is for JSON, and write the JSON with its provenance."""
    tables.show(tables.console(to_stderr=json == outputs.STDOUT), *parts)
    if json is not None:
        outputs.write_json(json, content | provenance(command, arm, recordings, seed))
