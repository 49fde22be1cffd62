"""Run the fast tests on the oldest and the newest versions that pyproject.toml allows; the exit code is 1 if a test failed."""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import asdict
from typing import Any

from benchmarks.versions.environment import Environment
from benchmarks.versions.interpreters import FIND
from benchmarks.versions.requirements import direct_requirements
from benchmarks.versions.suite import run_tests
from benchmarks.versions.table import keep, markdown
from flexarm_env.errors import InputError
from flexarm_env.terminal.provenance import commit


def main() -> int:
    """Run one or both sides, and print the table of both."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.versions", description=__doc__)
    parser.add_argument("--oldest", metavar="PYTHON", help="the oldest Python; found on the path by default")
    parser.add_argument("--newest", metavar="PYTHON", help="the newest Python; found on the path by default")
    parser.add_argument("--only", choices=list(FIND), help="run one of the two; the record keeps the other")
    parser.add_argument(
        "--without",
        nargs="*",
        default=["train"],
        metavar="EXTRA",
        help="extras left out with the newest versions; train by default, whose torch is one version, of gigabytes",
    )
    given = parser.parse_args()
    try:
        sides = [given.only] if given.only else list(FIND)
        pythons = {side: getattr(given, side) or FIND[side]() for side in sides}
        for side, python in pythons.items():
            runs = keep(side, measure(side, python, given.without if side == "newest" else []))
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    print(markdown(runs), end="")
    return 1 if any(run["failed"] for run in runs.values()) else 0


def measure(side: str, python: str, left_out: list[str]) -> dict[str, Any]:
    """Make the environment of a side, run the tests in it and describe both.

    Raises:
        InputError: if the environment cannot be made, or the tests were interrupted.
    """
    environment = Environment(side, tuple(direct_requirements(left_out)))
    print(f"Making {environment.folder.name} with {python}", flush=True)
    environment.make(python)
    began, at = time.perf_counter(), commit()
    counts = run_tests(environment)
    for reason, count in counts.skipped.items():
        print(f"{side}: {count} skipped: {reason}")
    return {
        "commit": at,
        "python": environment.python_version(),
        "requirements": environment.versions(),
        "left_out": left_out,
        **asdict(counts),
        "seconds": round(time.perf_counter() - began),
    }


if __name__ == "__main__":
    sys.exit(main())
