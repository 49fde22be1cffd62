"""Compare stored policies with every controller: python -m agents.compare writes results/policies/."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agents.compare_report import report_of
from agents.curves import draw_curves
from agents.evaluate import RATE, evaluate_controller
from agents.goals import THESIS, cell_of, verdicts
from agents.learning.artefact import Artefact
from agents.results import origin_of, write_results
from agents.train import FOLDER
from flexarm_env import Arm, InputError
from flexarm_env.controllers import CONTROLLERS
from flexarm_env.identify.workers import Workers
from flexarm_env.tasks import TASKS
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.trials.measures import MEASURES, measure
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.sets import FIRST_SEED, SETS


def find_policies(folder: Path) -> dict[str, list[Path]]:
    """Find the stored runs of each configuration, by its name.

    Raises:
        InputError: where there are none.
    """
    found: dict[str, list[Path]] = {}
    for path in sorted(folder.glob("*-*.safetensors")):
        found.setdefault(path.stem.rpartition("-")[0], []).append(path)
    if not found:
        raise InputError(f"no policies in {folder}; python -m agents.train configs/agents/ppo_slew.toml makes some")
    return found


def evaluate_policies(paths: Sequence[Path], task: str, arms: str, arm: str, count: int) -> dict[str, np.ndarray]:
    """Evaluate the runs of one configuration: each measure (runs, arms)."""
    nominal = Arm.load(arm)
    agents = [Artefact.load(path).agent() for path in paths]
    runs = [measure(roll_out(agent, TASKS[task], nominal, SETS[arms], count, RATE), TASKS[task]) for agent in agents]
    return {name: np.array([run[name] for run in runs]) for name in MEASURES}


def evaluate_any(task: str, arms: str, who: str | Sequence[Path], arm: str, count: int) -> dict[str, np.ndarray]:
    """Evaluate a controller, as one run, or a configuration's runs: each measure (runs, arms)."""
    if isinstance(who, str):
        return {name: values[None] for name, values in evaluate_controller(who, task, arms, arm, count).items()}
    return evaluate_policies(who, task, arms, arm, count)


def compare(policies: dict[str, list[Path]], arm: str, count: int, jobs: int) -> dict[str, Any]:
    """Evaluate all on each task and set; compare each policy with the best controller of both kinds."""
    tasks = {name: Artefact.load(paths[0]).plan.task for name, paths in policies.items()}
    work: dict[tuple[str, str, str], Any] = {}
    for task in TASKS:
        agents = dict.fromkeys(CONTROLLERS) | {name: None for name in policies if tasks[name] == task}
        work |= {(task, arms, name): policies.get(name, name) for arms in SETS for name in agents}
    began, values = time.perf_counter(), {}
    running = Workers(jobs).spread([(evaluate_any, (task, arms, who, arm, count)) for (task, arms, _), who in work.items()])
    for key, found in zip(work, running, strict=True):
        values[key] = found
        done = f"{len(values)} of {len(work)}: {' · '.join(key)}"
        print(f"\r{time.perf_counter() - began:4.0f} s  {done:<60}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return {task: {arms: _judged(_of(values, task, arms), policies) for arms in SETS} for task in TASKS}


def _of(values: dict[tuple[str, str, str], Any], task: str, arms: str) -> dict[str, Any]:
    return {name: found for (own_task, own_arms, name), found in values.items() if (own_task, own_arms) == (task, arms)}


def _judged(values: dict[str, Any], policies: dict[str, list[Path]]) -> dict[str, Any]:
    cells = {name: cell_of(found) for name, found in values.items()}
    rivals = {"thesis": THESIS, "classical": tuple(CONTROLLERS)}
    learned = [name for name in values if name in policies]
    return {
        "cells": cells,
        "verdicts": {name: {kind: verdicts(name, who, cells, values) for kind, who in rivals.items()} for name in learned},
    }


def about(policies: dict[str, list[Path]]) -> dict[str, Any]:
    """Describe each configuration: its runs' seeds, size and time, and its plan."""
    found = {}
    for name, paths in policies.items():
        runs = [Artefact.load(path) for path in paths]
        found[name] = {
            "runs": [{key: run.run[key] for key in ("seed", "version", "commit", "actions", "seconds")} for run in runs],
            "plan": runs[0].plan.table(),
        }
    return found


@Program()
def main(arguments: Sequence[str]) -> int:
    """Compare, write JSON, Markdown and the learning curves, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.compare", description=__doc__)
    parser.add_argument("--policies", type=Path, default=FOLDER, help="their folder; results/policies/weights by default")
    parser.add_argument("--arm", default="thesis", help="name or file of the arm; thesis by default")
    parser.add_argument("--count", type=int, default=100, help="arms in each set; 100 by default")
    parser.add_argument("--jobs", type=int, default=2, help="processes; 2 by default")
    parser.add_argument("--save", type=Path, default=FOLDER.parent, help="folder of the results; results/policies by default")
    asked = parser.parse_args(arguments)
    if asked.count < 1 or asked.jobs < 1:
        raise InputError(f"--count {asked.count}, --jobs {asked.jobs}; give whole numbers from 1 up")
    make_folder(asked.save, "policies.json", "policies.md", "curves.png")
    policies = find_policies(asked.policies)
    Arm.load(asked.arm)
    began = time.perf_counter()
    found = compare(policies, asked.arm, asked.count, asked.jobs)
    result = {
        **origin_of(f"python -m agents.compare --arm {asked.arm} --count {asked.count}", FIRST_SEED),
        "seconds": round(time.perf_counter() - began, 1),
        "arms": asked.count,
        "measures": {name: {"unit": unit, "meaning": meaning} for name, (unit, meaning) in MEASURES.items()},
        "sets": {name: entry.meaning for name, entry in SETS.items()},
        "policies": about(policies),
        "tasks": found,
    }
    place = write_results(asked.save, "policies", result, report_of(result))
    draw_curves({name: [Artefact.load(path) for path in paths] for name, paths in policies.items()}, asked.save / "curves.png")
    print(f"{place}: {len(policies)} configurations, {len(CONTROLLERS)} controllers, {result['seconds']} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
