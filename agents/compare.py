"""Compare stored policies with every controller: python -m agents.compare writes results/policies/; stopped, it goes on."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agents.cells import Name, Values, compute_cells
from agents.compare_report import report_of
from agents.curves import draw_curves
from agents.evaluate import EVERY_SET, RATE, evaluate_controller
from agents.goals import THESIS, cell_of, verdicts
from agents.learning.artefact import Artefact
from agents.results import cells_place, origin_of, write_results
from agents.train import FOLDER
from flexarm_env import Arm, InputError
from flexarm_env.controllers import CONTROLLERS
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


def evaluate_any(
    who: str | Sequence[Path], task: str, arms: str, nominal: Arm, count: int, first_seed: int = FIRST_SEED
) -> dict[str, np.ndarray]:
    """Evaluate a controller, as one run, or a configuration's runs: each measure (runs, arms)."""
    if isinstance(who, str):
        found = evaluate_controller(who, task, arms, nominal, count, first_seed)
        return {name: values[None] for name, values in found.items()}
    drawn = EVERY_SET[arms]
    agents = [Artefact.load(path).agent(1.0 / (RATE * drawn.rate_share)) for path in who]
    runs = [measure(roll_out(agent, TASKS[task], nominal, drawn, count, RATE, first_seed), TASKS[task]) for agent in agents]
    return {name: np.array([run[name] for run in runs]) for name in MEASURES}


def compare(policies: dict[str, list[Path]], arm: Arm, count: int, folder: Path, jobs: int) -> dict[str, Any]:
    """Evaluate all on each task and set; compare each policy with the best controller of both kinds."""
    tasks = {name: Artefact.load(paths[0]).plan.task for name, paths in policies.items()}
    agents = {task: [*CONTROLLERS, *(name for name in policies if tasks[name] == task)] for task in TASKS}
    cells = [(task, arms, name) for task in TASKS for arms in SETS for name in agents[task]]
    work = {(*cell, name): (evaluate_any, (policies.get(name, name), *cell, arm, count)) for *cell, name in cells}
    values = compute_cells(work, folder, jobs)
    return {task: {arms: _judged(_of(values, task, arms), policies) for arms in SETS} for task in TASKS}


def _of(values: Mapping[Name, Values], task: str, arms: str) -> dict[str, Values]:
    return {name: found for (own_task, own_arms, name), found in values.items() if (own_task, own_arms) == (task, arms)}


def _judged(values: dict[str, Values], policies: dict[str, list[Path]]) -> dict[str, Any]:
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


@Program(stopped="stopped; the same command goes on")
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
    arm, began = Arm.load(asked.arm), time.perf_counter()
    found = compare(policies, arm, asked.count, cells_place(asked.save, "policies"), asked.jobs)
    result = {
        **origin_of(f"python -m agents.compare --arm {asked.arm} --count {asked.count}", FIRST_SEED),
        "seconds": round(time.perf_counter() - began, 1),
        "arms": asked.count,
        "measures": {name: {"unit": unit, "meaning": meaning} for name, (unit, meaning) in MEASURES.items()},
        "sets": {name: entry.meaning for name, entry in SETS.items()},
        "policies": about(policies),
        "tasks": found,
    }
    draw_curves({name: [Artefact.load(path) for path in paths] for name, paths in policies.items()}, asked.save / "curves.png")
    place = write_results(asked.save, "policies", result, report_of(result))
    print(f"{place}: {len(policies)} configurations, {len(CONTROLLERS)} controllers, {result['seconds']} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
