"""The published table, as Markdown and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from benchmarks.hidden_effects.score import Figure, confusions, figures
from flexarm_env.files import write_whole


def against_goals(found: Sequence[Figure]) -> list[str]:
    """Format figures against their goals, as the lines of a table."""
    lines = ["| | goal | measured | |", "|---|---|---:|---|"]
    return lines + [f"| {f.what} | {f.goal} | {f.text} | {f.judged} |" for f in found]


def markdown(found: Sequence[Figure], mistakes: Sequence[tuple[str, str, int]], made: str) -> str:
    """Format the table of figures against goals, and the table of confusions."""
    lines = ["# Hidden effects", "", made, "", *against_goals(found)]
    lines += ["", "Single effects that were not named first, and what was said instead:", ""]
    lines += ["| hidden | said | cases |", "|---|---|---:|"]
    lines += [f"| {hidden} | {said} | {count} |" for hidden, said, count in mistakes]
    return "\n".join(lines) + "\n"


def origin(answers: Sequence[dict[str, Any]]) -> dict[str, list[str]]:
    """Collect the versions and commits that answered."""
    return {f"{key}s": sorted({answer[key] or "unknown" for answer in answers}) for key in ("version", "commit")}


def made_by(answers: Sequence[dict[str, Any]]) -> str:
    """Write the versions and commits that answered."""
    of = origin(answers)
    return f"FlexArm {', '.join(of['versions'])}, commit {', '.join(of['commits'])}"


def write(folder: Path, answers: Sequence[dict[str, Any]], method: str, seed: int, command: str) -> list[Figure]:
    """Write table.md and table.json into a folder, with the commits that answered; return the figures."""
    folder.mkdir(parents=True, exist_ok=True)
    found, mistakes = figures(answers), confusions(answers)
    stamp = {"command": command} | origin(answers) | {"seed": seed, "method": method}
    made = f"Method `{method}`, seed {seed}, {len(answers)} cases, answered by {made_by(answers)}: `{command}`"
    write_whole(folder / "table.md", markdown(found, mistakes, made))
    content = stamp | {"cases": len(answers), "figures": [asdict(f) for f in found], "mistakes": mistakes}
    write_whole(folder / "table.json", json.dumps(content, indent=1) + "\n")
    return found
