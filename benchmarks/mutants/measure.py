"""Measure which tests execute which line, once, and keep it."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from pathlib import Path

from coverage import CoverageData

from benchmarks.mutants.judge import SLOW_TOO
from benchmarks.mutants.reach import PACKAGE, PROJECT, Reach
from flexarm_env.files import write_whole

TESTS = (
    *(f"tests/{folder}" for folder in ("effects", "recordings", "sensors", "reference", "identify")),
    *(f"tests/test_{name}.py" for name in ("arm", "arm_file", "arm_file_one_joint", "units", "rig", "reference")),
)
#: Tests that are slow by what they compile alone: all of them are put to mutants.
COMPILING = ("tests/plant",)


def measured(path: Path) -> Reach:
    """Load what was measured, or measure it: the fast tests of `TESTS` and all of `COMPILING`, under coverage."""
    if not path.exists():
        with tempfile.TemporaryDirectory() as folder:
            _measure(Path(folder))
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, json.dumps(collected(Path(folder) / "data", sorted(Path(folder).glob("*.xml")))))
    kept = json.loads(path.read_text(encoding="utf-8"))
    names = kept["tests"]
    lines = {
        file: {int(line): [names[test] for test in tests] for line, tests in found.items()}
        for file, found in kept["lines"].items()
    }
    return Reach(dict(zip(names, kept["seconds"], strict=True)), lines)


def _measure(folder: Path) -> None:
    settings = folder / "settings"
    settings.write_text(f"[run]\nsource = {PACKAGE}\ndata_file = {folder / 'data'}\n")
    covered = (f"--cov={PACKAGE}", f"--cov-config={settings}", "--cov-context=test", "--cov-report=", "--cov-append")
    _run(*SLOW_TOO, *COMPILING)  # what compiling takes is not counted
    _run(*SLOW_TOO, *covered, f"--junitxml={folder / 'compiling.xml'}", *COMPILING)
    _run(*covered, f"--junitxml={folder / 'others.xml'}", *TESTS)


def _run(*arguments: str) -> None:
    command = [sys.executable, "-m", "pytest", "-q", "-n", "0", "-o", "junit_family=xunit1", *arguments]
    if subprocess.run(command, cwd=PROJECT, check=False, stdout=sys.stderr).returncode:
        sys.exit("the tests must pass before faults are put in; mend what fails")


def collected(data_file: Path, junits: Sequence[Path]) -> dict[str, object]:
    """Collect tests, their seconds, and by file and line the numbers of those that execute it."""
    seconds = {
        f"{case.get('file')}::{case.get('name')}": float(case.get("time", "0"))
        for junit in junits
        for case in ElementTree.parse(junit).iter("testcase")
        if not len(case)  # neither skipped nor failed
    }
    numbers = {test: number for number, test in enumerate(sorted(seconds))}
    data = CoverageData(str(data_file))
    data.read()
    lines: dict[str, dict[int, list[int]]] = {}
    for file in sorted(data.measured_files()):
        name = str(Path(file).relative_to(Path(file).parents[len(Path(file).parts) - Path(file).parts.index(PACKAGE) - 1]))
        for line, contexts in sorted(data.contexts_by_lineno(file).items()):
            tests = sorted({numbers[test] for context in contexts if (test := context.rpartition("|")[0]) in numbers})
            if tests:
                lines.setdefault(name, {})[line] = tests
    return {"tests": sorted(seconds), "seconds": [seconds[test] for test in sorted(seconds)], "lines": lines}
