"""Run the fast tests on the oldest and the newest versions that pyproject.toml allows; the exit code is 1 if a test failed."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from benchmarks.versions.environment import Environment
from benchmarks.versions.interpreters import FIND
from benchmarks.versions.requirements import direct_requirements
from benchmarks.versions.suite import folders_of_tests, run_tests
from benchmarks.versions.table import SIDES, keep, markdown, totals
from flexarm_env.terminal.program import Program
from flexarm_env.terminal.provenance import commit


@Program()
def main(arguments: Sequence[str]) -> int:
    """Run one or both sides, and print the table of both."""
    given = _parser().parse_args(arguments)
    sides = [given.only] if given.only else SIDES
    environments = {
        side: Environment(side, tuple(direct_requirements(given.without if side == "newest" else ()))) for side in sides
    }
    if not given.folders:
        pythons = {side: getattr(given, side) or FIND[side]() for side in sides}
        for side, environment in environments.items():
            print(f"Making {environment.folder.name} with {pythons[side]}", flush=True)
            environment.make(pythons[side])
    folders = given.folders or folders_of_tests()
    measured = {side: measure(environment, folders, given.without) for side, environment in environments.items()}
    runs = keep(measured)  # not before all are done: a test holds the record against its table in a document
    print(markdown(runs), end="")
    return 1 if any(totals(runs[side])[1] for side in sides) else 0


def measure(environment: Environment, folders: Sequence[str], left_out: Sequence[str]) -> dict[str, Any]:
    """Run the tests of some folders in an environment, and describe both.

    Raises:
        InputError: if the tests were interrupted.
    """
    at = commit()
    counts = run_tests(environment, folders)
    return {
        "python": environment.python_version(),
        "requirements": environment.versions(),
        "left_out": list(left_out) if environment.side == "newest" else [],
        "folders": {name: {"commit": at, "other_versions": {}, **asdict(each)} for name, each in counts.items()},
    }


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.versions", description=__doc__)
    parser.add_argument("--oldest", metavar="PYTHON", help="the oldest Python; found on the path by default")
    parser.add_argument("--newest", metavar="PYTHON", help="the newest Python; found on the path by default")
    parser.add_argument("--only", choices=SIDES, help="run one of the two; the record keeps the other")
    parser.add_argument(
        "--folders",
        nargs="+",
        choices=folders_of_tests(),
        metavar="FOLDER",
        help="run these folders of tests again, in the environments as they are; the record keeps the others",
    )
    parser.add_argument(
        "--without",
        nargs="*",
        default=["train"],
        metavar="EXTRA",
        help="extras left out with the newest versions; train by default, whose torch is one version, of gigabytes",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
