"""The published table, as Markdown and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from benchmarks.answers.figures import Figure
from benchmarks.answers.tables import against_goals, made_by, origin
from benchmarks.hidden_effects.score import confusions, figures
from flexarm_env.files import write_whole


def markdown(found: Sequence[Figure], mistakes: Sequence[tuple[str, str, int]], made: str) -> str:
    """Format the table of figures against goals, and the table of confusions."""
    lines = ["# Hidden effects", "", made, "", *against_goals(found)]
    lines += ["", "Single effects that were not named first, and what was said instead:", ""]
    lines += ["| hidden | said | cases |", "|---|---|---:|"]
    lines += [f"| {hidden} | {said} | {count} |" for hidden, said, count in mistakes]
    return "\n".join(lines) + "\n"


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
