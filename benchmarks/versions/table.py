"""The record of both runs, and its table."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from benchmarks.versions.requirements import PROJECT
from flexarm_env.files import write_whole

RECORD = PROJECT / "results" / "versions" / "versions.json"
#: Requirements that have a column.
SHOWN = ("numpy", "scipy", "numba", "gymnasium")


def keep(side: str, run: Mapping[str, Any]) -> dict[str, Any]:
    """Put a run in its place of the record, beside the other one.

    Raises:
        InputError: if the record cannot be written.
    """
    runs = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.is_file() else {}
    runs = {name: (runs | {side: run})[name] for name in ("oldest", "newest") if name in runs or name == side}
    RECORD.parent.mkdir(parents=True, exist_ok=True)
    write_whole(RECORD, json.dumps(runs, indent=1, ensure_ascii=False) + "\n")
    return runs


def markdown(runs: Mapping[str, Mapping[str, Any]]) -> str:
    """Tabulate the versions and the counts of each run, and say what was left out."""
    lines = [
        f"| versions | Python | {' | '.join(SHOWN)} | passed | failed | skipped |",
        "|---|" + "---:|" * (len(SHOWN) + 4),
    ]
    for side, run in runs.items():
        versions = [run["python"], *(run["requirements"][name] for name in SHOWN)]
        counts = [run["passed"], len(run["failed"]), sum(run["skipped"].values())]
        lines.append(f"| {side} | {' | '.join(map(str, [*versions, *counts]))} |")
    left_out = [f"`{name}` with the {side}" for side, run in runs.items() for name in run["left_out"]]
    if left_out:
        lines += [
            "",
            f"Extras left out: {', '.join(left_out)}; a file of tests that needs one is skipped whole, and counts as one.",
        ]
    return "\n".join(lines) + "\n"
