"""The published table, as Markdown and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from benchmarks.answers.figures import Figure
from benchmarks.answers.tables import against_goals, made_by, origin
from benchmarks.machines.lacks import COUNTS
from benchmarks.machines.score import Answer, figures, is_solved
from flexarm_env.files import write_whole


def by_family(answers: Sequence[Answer]) -> list[str]:
    """Format the number of right answers by family and kind, as the lines of a table."""
    kinds = [kind for kind in COUNTS if any(a["case"]["kind"] == kind for a in answers)]
    lines = [f"| family | {' | '.join(kinds)} |", "|---|" + "---:|" * len(kinds)]
    for family in sorted({a["case"]["family"] for a in answers}):
        own = [[a for a in answers if (a["case"]["family"], a["case"]["kind"]) == (family, kind)] for kind in kinds]
        cells = [f"{sum(map(is_solved, some))} of {len(some)}" if some else "" for some in own]
        lines.append(f"| {family} | {' | '.join(cells)} |")
    return lines


def misses(answers: Sequence[Answer]) -> list[str]:
    """Format the cases that were not answered right, as the lines of a table."""
    lines = ["| case | family | hidden | strength | verdict | named | error |", "|---|---|---|---|---|---|---:|"]
    for answer in answers:
        if not is_solved(answer):
            case, found = answer["case"], answer["found"]
            strengths = ", ".join(f"{strength:.1f}" for strength in case["strengths"])
            named, hidden = (", ".join(part["effects"]) for part in (found, case))
            error = f"{found['error']['nominal']:.3g} → {found['error']['final']:.3g}" if found["error"] else ""
            row = (case["name"], case["family"], hidden, strengths, found["verdict"], named, error)
            lines.append(f"| {' | '.join(row)} |")
    return lines


def markdown(answers: Sequence[Answer], found: Sequence[Figure], made: str) -> str:
    """Format the tables of figures, of families and of misses."""
    lines = ["# Machines", "", made, "", *against_goals(found), "", "Right answers by family and kind:", "", *by_family(answers)]
    lines += [
        "",
        "Cases that were not answered right; the error is that of the arm as given and that at the end, over the noise:",
    ]
    return "\n".join([*lines, "", *misses(answers)]) + "\n"


def write(folder: Path, answers: Sequence[Answer], seed: int, command: str) -> list[Figure]:
    """Write table.md and table.json into a folder, with the commits that answered; return the figures."""
    folder.mkdir(parents=True, exist_ok=True)
    found = figures(answers)
    made = f"Seed {seed}, {len(answers)} cases, answered by {made_by(answers)}: `{command}`"
    write_whole(folder / "table.md", markdown(answers, found, made))
    stamp = {"command": command} | origin(answers) | {"seed": seed, "cases": len(answers)}
    write_whole(folder / "table.json", json.dumps(stamp | {"figures": [asdict(f) for f in found]}, indent=1) + "\n")
    return found
