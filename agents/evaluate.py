"""Evaluate controllers on fixed sets of arms: python -m agents.evaluate writes results/baselines/; stopped, it goes on."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agents.cells import Name, Values, compute_cells
from agents.report import table_of
from agents.results import cells_place, origin_of, write_results
from agents.statistics import mean_interval, paired_difference
from flexarm_env import Arm, InputError
from flexarm_env.controllers import CONTROLLERS, make_controller
from flexarm_env.errors import did_you_mean
from flexarm_env.tasks import TASKS
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.trials.measures import MEASURES, measure
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.score import worst_tenth
from flexarm_env.trials.sets import DEVELOPMENT_SEED, FIRST_SEED, ROBUSTNESS, SETS

FOLDER = Path(__file__).resolve().parent.parent / "results" / "baselines"
REFERENCE = "pd"
EVERY_SET = SETS | ROBUSTNESS
RATE = 200.0


def evaluate_controller(
    name: str, task: str, arms: str, nominal: Arm, count: int, first_seed: int = FIRST_SEED
) -> dict[str, np.ndarray]:
    """Evaluate a controller designed on the nominal arm: each measure (arms,)."""
    drawn = EVERY_SET[arms]
    controller = make_controller(name, nominal, 1.0 / (RATE * drawn.rate_share))
    return measure(roll_out(controller, TASKS[task], nominal, drawn, count, RATE, first_seed), TASKS[task])


def evaluate(names: Sequence[str], arm: Arm, count: int, first_seed: int, folder: Path, jobs: int) -> dict[str, Any]:
    """Evaluate controllers on all tasks and sets: each measure's mean and interval, and its difference from PD's."""
    cells = [(task, arms, name) for task in TASKS for arms in SETS for name in names]
    work = {(*cell, name): (evaluate_controller, (name, *cell, arm, count, first_seed)) for *cell, name in cells}
    found = compute_cells(work, folder, jobs)
    return {task: {arms: {name: _cell(found, task, arms, name) for name in names} for arms in SETS} for task in TASKS}


def _cell(found: Mapping[Name, Values], task: str, arms: str, name: str) -> dict[str, Any]:
    cell: dict[str, Any] = {}
    reference = found.get((task, arms, REFERENCE))
    for key, values in found[task, arms, name].items():
        mean, low, high = mean_interval(values)
        cell[key] = {"mean": mean, "low": low, "high": high, "worst_tenth": float(worst_tenth(values))}
        if reference is not None and name != REFERENCE:
            mean, low, high = paired_difference(values, reference[key])
            cell[key]["less_than_pd"] = {"mean": -mean, "low": -high, "high": -low}
    return cell


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> int:
    """Evaluate, write the JSON file and the table, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.evaluate", description=__doc__)
    parser.add_argument("--controllers", nargs="+", default=list(CONTROLLERS), metavar="NAME", help="all by default")
    parser.add_argument("--arm", default="thesis", help="name or file of the arm; thesis by default")
    parser.add_argument("--count", type=int, default=100, help="arms in each set; 100 by default")
    parser.add_argument("--jobs", type=int, default=2, help="processes; 2 by default")
    parser.add_argument(
        "--development", action="store_true", help="arms for choices of design, other ones than those of published figures"
    )
    parser.add_argument("--save", type=Path, default=FOLDER, help="folder of the results; results/baselines by default")
    asked = parser.parse_args(arguments)
    for name in asked.controllers:
        if name not in CONTROLLERS:
            raise InputError(f"no controller '{name}'{did_you_mean(name, CONTROLLERS)}")
    if asked.count < 1 or asked.jobs < 1:
        raise InputError(f"--count {asked.count}, --jobs {asked.jobs}; give whole numbers from 1 up")
    arm = Arm.load(asked.arm)
    make_folder(asked.save, "baselines.json", "baselines.md")
    began = time.perf_counter()
    first_seed = DEVELOPMENT_SEED if asked.development else FIRST_SEED
    cells = evaluate(asked.controllers, arm, asked.count, first_seed, cells_place(asked.save, "baselines"), asked.jobs)
    command = f"python -m agents.evaluate --arm {asked.arm} --count {asked.count}{' --development' * asked.development}"
    result = {
        **origin_of(command, first_seed),
        "seconds": round(time.perf_counter() - began, 1),
        "arms": asked.count,
        "measures": {name: {"unit": unit, "meaning": meaning} for name, (unit, meaning) in MEASURES.items()},
        "sets": {name: found.meaning for name, found in SETS.items()},
        "controllers": {name: CONTROLLERS[name].meaning for name in asked.controllers},
        "cells": cells,
    }
    place = write_results(asked.save, "baselines", result, table_of(result))
    print(f"{place}: {len(asked.controllers)} controllers in {result['seconds']} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
