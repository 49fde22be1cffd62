"""Diagnose the cases, each into its own file, which lets an interrupted run resume."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from joblib import Parallel, delayed

import flexarm_env
from benchmarks.hidden_effects.cases import Case
from benchmarks.hidden_effects.machine import record
from flexarm_env import Arm, Recording, diagnose
from flexarm_env.files import write_whole
from flexarm_env.terminal.provenance import commit

Method = Callable[[Arm, Sequence[Recording]], dict[str, Any]]
ARM = "thesis-fem"


def by_diagnosis(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Diagnose, with the result as of `flexarm diagnose --json`."""
    return diagnose(arm, recordings, jobs=1).as_json()


def _answer(case: Case, method: Method, folder: Path) -> dict[str, Any]:
    path = folder / f"{case.name}.json"
    if path.exists():
        kept: dict[str, Any] = json.loads(path.read_text())
        if kept["case"] == json.loads(json.dumps(case.as_json())):
            return kept
    began = time.process_time()
    found = method(Arm.load(ARM), record(case))
    seconds = round(time.process_time() - began, 1)
    made_by = {"version": flexarm_env.__version__, "commit": commit()}
    answer = {"case": case.as_json(), "found": found, "cpu_seconds": seconds} | made_by
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
    tasks = [delayed(_answer)(case, method, folder) for case in cases]
    # Stored answers take no time, from which joblib would infer to hand out long cases in large batches.
    for answer in Parallel(n_jobs=jobs, return_as="generator", batch_size=1)(tasks):
        answers.append(answer)
        say(len(answers), answer)
    return answers
