"""Time of a diagnosis of fixed cases by stage, its residuals and replays, beside the last stored run."""

from __future__ import annotations

import datetime
import json
import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import flexarm_env
from benchmarks.diagnosis import table
from benchmarks.diagnosis.cases import CASES, Case
from benchmarks.diagnosis.count import Stages, counting
from flexarm_env import Arm, diagnose, simulate
from flexarm_env.files import write_whole
from flexarm_env.terminal.provenance import commit

STORED = Path(__file__).resolve().parents[2] / "results" / "speed"
JOBS = 2


def measure(
    say: Callable[[str], None], names: Sequence[str] | None = None, jobs: int = JOBS, folder: Path = STORED
) -> dict[str, Any]:
    """Diagnose cases, write their times and counts to a folder, and give the figures of groups that are whole.

    Args:
        say: called with progress, a line each.
        names: of the cases; all by default.
        jobs: processes.
        folder: of the last stored run. Cases that are not run stay there as they are.
    """
    _compile(jobs)
    path = folder / "diagnosis.json"
    before = json.loads(path.read_text(encoding="utf-8"))["cases"] if path.exists() else {}
    found: dict[str, Any] = {}
    for name in names or CASES:
        found[name] = run(CASES[name], jobs)
        say(table.line(name, found[name], before.get(name)))
    cases = {name: (before | found)[name] for name in CASES if name in before | found}
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(path, json.dumps({"command": "python -m benchmarks --diagnosis", "cases": cases}, indent=1) + "\n")
    write_whole(folder / "diagnosis.md", table.markdown(cases))
    for line in table.lines(found, before):
        print(line)
    return figures(found)


def run(case: Case, jobs: int) -> dict[str, Any]:
    """Diagnose a case; give its answer, its times and its counts."""
    arm, recordings = case.load()
    load, began = os.getloadavg()[0] if hasattr(os, "getloadavg") else None, time.perf_counter()
    with counting() as stages:
        found = diagnose(arm, recordings, jobs=jobs)
    seconds = time.perf_counter() - began
    return {
        "hidden": list(case.hidden),
        "verdict": str(found.verdict),
        "effects": list(found.effects),
        "error": found.error["final"],
        "seconds": round(seconds, 3),
        "cpu_seconds": round(stages.cpu_seconds, 3),
        "jobs": jobs,
        "stages": by_stage(stages),
        "version": flexarm_env.__version__,
        "commit": commit(),
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "load": load,
    }


def by_stage(stages: Stages) -> dict[str, dict[str, Any]]:
    """List wall time, calls of parts and their CPU time, by stage."""
    return {
        stage: {
            "seconds": round(stages.seconds[stage], 3),
            "calls": dict(calls),
            "cpu_seconds": {part: round(own, 3) for part, own in spent.items()},
        }
        for stage, (calls, spent) in stages.parts.items()
    }


def figures(found: dict[str, dict[str, Any]]) -> dict[str, float]:
    """Compute the seconds of groups of which every case was run: the median and the longest."""
    result = {}
    for group in dict.fromkeys(case.group for case in CASES.values()):
        names = [name for name, case in CASES.items() if case.group == group]
        if all(name in found for name in names):
            seconds = [found[name]["seconds"] for name in names]
            key = group.replace(" ", "_")
            result |= {f"{key}_median_s": float(np.median(seconds)), f"{key}_longest_s": max(seconds)}
    return result


def _compile(jobs: int) -> None:
    """Compile all code and start the processes, which is no part of a diagnosis."""
    arm = Arm.load("cu-rigid")
    diagnose(arm, [simulate(arm.with_effect("coulomb", torque=0.05), "square", duration=2.0, rate=100.0)], jobs=jobs)
