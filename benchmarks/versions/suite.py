"""The fast tests in an environment, and their counts."""

from __future__ import annotations

import os
import re
import subprocess
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.versions.environment import Environment
from benchmarks.versions.requirements import PROJECT
from flexarm_env.errors import InputError

TESTS = PROJECT / "tests"
#: The name of the folder tests itself, whose files are beside the folders.
TOP = "."
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


def folders_of_tests() -> list[str]:
    """List the folders of tests/ that have tests, and TOP."""
    return sorted({(*file.relative_to(TESTS).parent.parts, TOP)[0] for file in TESTS.rglob("test_*.py")})


def run_tests(environment: Environment, folders: Sequence[str]) -> dict[str, Counts]:
    """Run the fast tests of some folders, with a cache of compiled kernels of its own, and count them by folder.

    Raises:
        InputError: if the tests were interrupted.
    """
    report = environment.folder / "tests.xml"
    files = [str(file) for folder in folders for file in _files(folder)]
    command = [environment.python, "-m", "pytest", *WORKERS, f"--junit-xml={report}", *files]
    variables = os.environ | {"XDG_CACHE_HOME": str(CACHES / environment.side)}
    variables.pop("FLEXARM_CACHE", None)
    code = subprocess.run(command, cwd=PROJECT, env=variables, check=False).returncode
    if code not in COMPLETE:
        raise InputError(f"the tests ended with exit code {code}, before they were complete; nothing is recorded")
    return read_counts(report)


def _files(folder: str) -> list[Path]:
    return sorted(TESTS.glob("test_*.py")) if folder == TOP else [TESTS / folder]


def read_counts(report: Path) -> dict[str, Counts]:
    """Count the tests of a report in JUnit's format, as pytest writes it, by folder of tests/."""
    passed, failed, skipped = Counter[str](), dict[str, list[str]](), dict[str, Counter[str]]()
    for case in ET.parse(report).getroot().iter("testcase"):
        # "tests.cli.test_tune", or nothing and "tests.cli.test_tune" for a file that is skipped whole
        name = f"{case.get('classname') or ''}.{case.get('name')}".lstrip(".")
        folder = _folder(name)
        if (skip := case.find("skipped")) is not None:
            skipped.setdefault(folder, Counter())[_reason(skip)] += 1
        elif case.find("failure") is not None or case.find("error") is not None:
            failed.setdefault(folder, []).append(name)
        else:
            passed[folder] += 1
    return {
        each: Counts(passed[each], tuple(failed.get(each, ())), dict(sorted(skipped.get(each, {}).items())))
        for each in sorted(passed.keys() | failed.keys() | skipped.keys())
    }


def _folder(name: str) -> str:
    second = name.split(".")[1]
    return TOP if second.startswith("test_") else second


def _reason(skip: ET.Element) -> str:
    """Take the reason of a skip, without folders of this machine; a file that is skipped whole has it in its text."""
    whole = re.search(r"Skipped: (.*?)['\"]\)$", skip.text or "", re.DOTALL)
    reason = whole[1] if skip.get("message") == "collection skipped" and whole else skip.get("message", "")
    return reason.replace(str(PROJECT.parent), "..")
