"""Measure the share of lines that the fast tests execute, by part of the program: python -m benchmarks.lines.

Compiled functions are left out: coverage sees no line of them.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import textwrap
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import flexarm_env
from flexarm_env.errors import InputError
from flexarm_env.files import write_whole
from flexarm_env.terminal.program import Program
from flexarm_env.terminal.provenance import commit

PROJECT = Path(__file__).resolve().parents[1]
RESULTS = PROJECT / "results" / "lines" / "lines.json"
#: Least share of all lines that tests should execute [%].
GOAL = 95.0
#: Characters of a line of a document.
WIDTH = 124


@Program()
def main(arguments: Sequence[str]) -> None:
    """Run the fast tests under coverage, and write and print what they executed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.lines", description=__doc__)
    parser.add_argument("--out", type=Path, default=RESULTS, help="file of the figures")
    asked, at = parser.parse_args(arguments), commit()
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "pytest", "-q", "-n", "auto", "--cov", f"--cov-report=json:{report}"]
        if subprocess.run(command, cwd=PROJECT, check=False).returncode:
            raise InputError("the tests must pass before their lines are counted; mend what fails")
        found = record(json.loads(report.read_text(encoding="utf-8")), at)
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    write_whole(asked.out, json.dumps(found, indent=1) + "\n")
    print(words(found), end="")


def record(report: Mapping[str, Any], at: str) -> dict[str, Any]:
    """Sum a report of coverage by part, such as `flexarm_env/plant`.

    Args:
        report: as `coverage json` writes it.
        at: the commit.
    """
    parts: defaultdict[str, dict[str, int]] = defaultdict(lambda: {"lines": 0, "executed": 0})
    for name, file in report["files"].items():
        folders = Path(name).parts[:-1]
        part = parts["/".join(folders[: 2 if folders[0] == "flexarm_env" else 1])]
        part["lines"] += file["summary"]["num_statements"]
        part["executed"] += file["summary"]["covered_lines"]
    total = {key: sum(part[key] for part in parts.values()) for key in ("lines", "executed")}
    return {
        "command": "python -m benchmarks.lines",
        "version": flexarm_env.__version__,
        "commit": at,
        "goal_percent": GOAL,
        "total": total,
        "parts": dict(sorted(parts.items())),
    }


def words(found: Mapping[str, Any]) -> str:
    """Say the share of all lines, and name the parts whose share is below the goal."""
    goal = found["goal_percent"]
    below = [f"`{name}` {share:.0f} %" for name, part in found["parts"].items() if (share := _percent(part)) < goal]
    at, lines = found["commit"][:9], found["total"]["lines"]
    text = (
        f"The fast tests execute {_percent(found['total']):.1f} % of {lines:,} lines (goal {goal:.0f} %; commit {at}, "
        f"compiled functions left out). Below the goal: {', '.join(below) or 'no part'}."
    )
    return textwrap.fill(text, WIDTH) + "\n"


def _percent(part: Mapping[str, int]) -> float:
    return 100.0 * part["executed"] / part["lines"] if part["lines"] else 100.0


if __name__ == "__main__":
    main()
