"""Parts of published tables: figures against goals, and who answered."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmarks.answers.figures import Figure


def against_goals(found: Sequence[Figure]) -> list[str]:
    """Format figures against their goals, as the lines of a table."""
    lines = ["| | goal | measured | |", "|---|---|---:|---|"]
    return lines + [f"| {f.what} | {f.goal} | {f.text} | {f.judged} |" for f in found]


def origin(answers: Sequence[dict[str, Any]]) -> dict[str, list[str]]:
    """Collect the versions and commits that answered."""
    return {f"{key}s": sorted({answer[key] or "unknown" for answer in answers}) for key in ("version", "commit")}


def made_by(answers: Sequence[dict[str, Any]]) -> str:
    """Write the versions and commits that answered."""
    of = origin(answers)
    return f"FlexArm {', '.join(of['versions'])}, commit {', '.join(of['commits'])}"
