"""Compare controllers and policies on machines other than they were made for: python -m agents.robustness.

Stopped, the same command goes on.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agents.cells import Values, compute_cells
from agents.compare import evaluate_any, find_policies
from agents.goals import mean
from agents.learning.artefact import Artefact
from agents.results import cells_place, origin_of, write_results
from agents.robustness_report import report_of
from agents.statistics import Interval, improvement, stratified_interval
from agents.train import FOLDER as WEIGHTS
from flexarm_env import Arm, InputError
from flexarm_env.controllers import CONTROLLERS
from flexarm_env.errors import did_you_mean
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.trials.score import cost, worst_tenth
from flexarm_env.trials.sets import DEVELOPMENT_SEED, FIRST_SEED, ROBUSTNESS

FOLDER = Path(__file__).resolve().parent.parent / "results" / "robustness"
TASK = "slew"
#: Measures of the report.
SHOWN = ("settling_time", "unsettled", "steady_error", "residual_strain")


def cell_of(values: Values) -> dict[str, Any]:
    """Compute the mean and the worst tenth of each shown measure with their 95 % intervals, and the number of runs."""
    found: dict[str, Any] = {"runs": len(values["unsettled"])}
    for name in SHOWN:
        found[name] = {
            "mean": _with_names(stratified_interval([values[name]], mean)),
            "worst_tenth": _with_names(stratified_interval([values[name]], worst_tenth)),
        }
    return found


def verdict_of(values: Mapping[str, Values], policies: Sequence[str]) -> dict[str, Any] | None:
    """Compare the best policy with the best controller, both by their mean cost; None without a policy.

    The comparison is by the cost, the mean logarithm of settling time, error and strain, and by each of these three.
    """
    costs = {name: float(cost(found).mean()) for name, found in values.items()}
    learned, made = (sorted((c, n) for n, c in costs.items() if (n in policies) == side) for side in (True, False))
    if not learned or not made:
        return None
    (own_cost, own), (other_cost, other) = learned[0], made[0]
    better = {"cost": improvement(cost(values[own]), cost(values[other]))}
    better |= {name: improvement(values[own][name], values[other][name]) for name in SHOWN if name != "unsettled"}
    return {
        "policy": own,
        "controller": other,
        "less_by": 1.0 - float(np.exp(own_cost - other_cost)),
        "probability": {name: _with_names(found) for name, found in better.items()},
    }


def _with_names(found: Interval) -> dict[str, float]:
    return dict(zip(("value", "low", "high"), found, strict=True))


def evaluate(
    agents: Mapping[str, str | Sequence[Path]], arm: Arm, count: int, first_seed: int, folder: Path, jobs: int
) -> dict[str, dict[str, Values]]:
    """Evaluate agents on every set: each measure (runs, arms), by set and agent."""
    cells = [(arms, name) for arms in ROBUSTNESS for name in agents]
    work = {(arms, name): (evaluate_any, (agents[name], TASK, arms, arm, count, first_seed)) for arms, name in cells}
    found = compute_cells(work, folder, jobs)
    return {arms: {name: found[arms, name] for name in agents} for arms in ROBUSTNESS}


def chosen(names: Sequence[str], folder: Path) -> dict[str, str | Sequence[Path]]:
    """Look up controllers and stored configurations of the task by name.

    Raises:
        InputError: for a name that is neither.
    """
    stored = {name: paths for name, paths in find_policies(folder).items() if Artefact.load(paths[0]).plan.task == TASK}
    every: dict[str, str | Sequence[Path]] = {name: name for name in CONTROLLERS} | stored
    for name in names:
        if name not in every:
            raise InputError(f"no controller or policy '{name}'{did_you_mean(name, every)}")
    return {name: every[name] for name in names or every}


def result_of(
    asked: argparse.Namespace, agents: Mapping[str, Any], values: Mapping[str, Mapping[str, Values]], seconds: float
) -> dict[str, Any]:
    """Gather cells and verdicts, and how they were made."""
    policies = [name for name, who in agents.items() if not isinstance(who, str)]
    words = [*asked.names, "--arm", asked.arm, "--count", str(asked.count), *["--development"] * asked.development]
    return {
        **origin_of(" ".join(["python -m agents.robustness", *words]), first_seed_of(asked)),
        "arms": asked.count,
        "seconds": round(seconds, 1),
        "sets": {name: found.meaning for name, found in ROBUSTNESS.items()},
        "policies": policies,
        "cells": {arms: {name: cell_of(found) for name, found in each.items()} for arms, each in values.items()},
        "verdicts": {arms: verdict_of(each, policies) for arms, each in values.items()},
    }


def first_seed_of(asked: argparse.Namespace) -> int:
    """Look up the seed of the first arm of a set."""
    return DEVELOPMENT_SEED if asked.development else FIRST_SEED


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> int:
    """Compare, write JSON and Markdown, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.robustness", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="controllers and stored policies; all by default")
    parser.add_argument("--policies", type=Path, default=WEIGHTS, help="their folder; results/policies/weights by default")
    parser.add_argument("--arm", default="thesis", help="name or file of the arm; thesis by default")
    parser.add_argument("--count", type=int, default=100, help="arms in each set; 100 by default")
    parser.add_argument("--development", action="store_true", help="arms for choices of design, not those of published figures")
    parser.add_argument("--jobs", type=int, default=2, help="processes; 2 by default")
    parser.add_argument("--save", type=Path, default=FOLDER, help="folder of the results; results/robustness by default")
    asked = parser.parse_args(arguments)
    began = time.perf_counter()
    if asked.count < 1 or asked.jobs < 1:
        raise InputError(f"--count {asked.count}, --jobs {asked.jobs}; give whole numbers from 1 up")
    make_folder(asked.save, "robustness.json", "robustness.md")
    agents, arm, place = chosen(asked.names, asked.policies), Arm.load(asked.arm), cells_place(asked.save, "robustness")
    values = evaluate(agents, arm, asked.count, first_seed_of(asked), place, asked.jobs)
    result = result_of(asked, agents, values, time.perf_counter() - began)
    place = write_results(asked.save, "robustness", result, report_of(result))
    print(f"{place}: {len(agents)} controllers and policies, {result['seconds']} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
