"""The fast tests in an environment, and their counts."""

from __future__ import annotations

import os
import re
import subprocess
import xml.etree.ElementTree as ET
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from benchmarks.versions.environment import Environment
from benchmarks.versions.requirements import PROJECT
from flexarm_env.errors import InputError

#: Exit codes of pytest after which its counts are complete: all passed, some failed.
COMPLETE = (0, 1)
#: Compiled kernels of either environment, kept when the environment is made anew.
CACHES = PROJECT / "build" / "versions"
WORKERS = ("-n", "auto", "--maxprocesses", "8", "--dist", "worksteal")


@dataclass(frozen=True)
class Counts:
    """Counts of tests; `skipped` has one for each reason, in which a file that is skipped whole counts as one."""

    passed: int
    failed: tuple[str, ...]
    skipped: dict[str, int]


def run_tests(environment: Environment) -> Counts:
    """Run the fast tests, with a cache of compiled kernels of its own.

    Raises:
        InputError: if the tests were interrupted.
    """
    report = environment.folder / "tests.xml"
    command = [environment.python, "-m", "pytest", *WORKERS, f"--junit-xml={report}"]
    variables = os.environ | {"XDG_CACHE_HOME": str(CACHES / environment.side)}
    variables.pop("FLEXARM_CACHE", None)
    code = subprocess.run(command, cwd=PROJECT, env=variables, check=False).returncode
    if code not in COMPLETE:
        raise InputError(f"the tests ended with exit code {code}, before they were complete; nothing is recorded")
    return read_counts(report)


def read_counts(report: Path) -> Counts:
    """Count the tests of a report in JUnit's format, as pytest writes it."""
    passed, failed, skipped = 0, list[str](), Counter[str]()
    for case in ET.parse(report).getroot().iter("testcase"):
        if (skip := case.find("skipped")) is not None:
            skipped[_reason(skip)] += 1
        elif case.find("failure") is not None or case.find("error") is not None:
            failed.append(f"{case.get('classname')}::{case.get('name')}")
        else:
            passed += 1
    return Counts(passed, tuple(failed), dict(sorted(skipped.items())))


def _reason(skip: ET.Element) -> str:
    """Take the reason of a skip, without folders of this machine; a file that is skipped whole has it in its text."""
    whole = re.search(r"Skipped: (.*?)['\"]\)$", skip.text or "", re.DOTALL)
    reason = whole[1] if skip.get("message") == "collection skipped" and whole else skip.get("message", "")
    return reason.replace(str(PROJECT.parent), "..")
