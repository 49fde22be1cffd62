"""Parts of reports as Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

#: Names of the value that an interval is around.
CENTRES = ("value", "iqm", "mean")


def origin_line(result: Mapping[str, Any]) -> str:
    """Format the command, version, commit and seed of a result."""
    return f"`{result['command']}`, version {result['version']}, commit {result['commit']}, seed {result['seed']}."


def row(entries: Sequence[str]) -> str:
    """Format a row of a table."""
    return "| " + " | ".join(entries) + " |"


def with_interval(value: Mapping[str, float], digits: int) -> str:
    """Format a value, interquartile mean or mean, with the ends of its interval."""
    centre = next(value[name] for name in CENTRES if name in value)
    return f"{centre:.{digits}f} ({value['low']:.{digits}f} to {value['high']:.{digits}f})"
