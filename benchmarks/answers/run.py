"""Diagnose the cases, each into its own file, which lets an interrupted run resume."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol

import flexarm_env
from flexarm_env import Arm, Recording, diagnose
from flexarm_env.files import read_json, write_whole
from flexarm_env.identify.workers import Workers
from flexarm_env.terminal.provenance import commit

Method = Callable[[Arm, Sequence[Recording]], dict[str, Any]]


class Case(Protocol):
    """A machine to be diagnosed, of any benchmark."""

    @property
    def name(self) -> str:
        """Name of its answer."""

    def as_json(self) -> dict[str, Any]:
        """Convert what is known before the case is made to plain data; it does not change from run to run."""

    def pose(self) -> tuple[dict[str, Any], Arm, Sequence[Recording]]:
        """Make the case: its plain data with all of those above, the arm as given and the recordings."""


def by_diagnosis(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Diagnose, with the result as of `flexarm diagnose --json`."""
    return diagnose(arm, recordings, jobs=1).as_json()


def _answer(case: Case, method: Method, folder: Path) -> dict[str, Any]:
    path = folder / f"{case.name}.json"
    if path.exists():
        kept = read_json(path, "delete it, and it is made anew")
        if kept["case"].items() >= json.loads(json.dumps(case.as_json())).items():
            return kept
    posed, arm, recordings = case.pose()
    began = time.process_time()
    found = method(arm, recordings)
    seconds = round(time.process_time() - began, 1)
    made_by = {"version": flexarm_env.__version__, "commit": commit()}
    answer = {"case": posed, "found": found, "cpu_seconds": seconds} | made_by
    write_whole(path, json.dumps(answer, indent=1) + "\n")
    return answer


def run(
    cases: Sequence[Case], method: Method, folder: Path, jobs: int, say: Callable[[int, dict[str, Any]], None]
) -> list[dict[str, Any]]:
    """Collect a method's answer to each case.

    Args:
        cases: to be diagnosed.
        method: takes the arm and the recordings.
        folder: of the answers; existing ones are read from it.
        jobs: number of processes; joblib's backends spread them over more machines.
        say: called with the number of answers so far and the latest.
    """
    folder.mkdir(parents=True, exist_ok=True)
    answers = []
    tasks = [(_answer, (case, method, folder)) for case in cases]
    # Stored answers take no time, from which joblib would infer to hand out long cases in large batches.
    for answer in Workers(jobs, batch=1).spread(tasks):
        answers.append(answer)
        say(len(answers), answer)
    return answers
