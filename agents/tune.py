"""Search for better options with Optuna: python -m agents.tune configs/agents/ppo_slew.toml --storage search.journal."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agents.goals import GOALS
from agents.learning.options import Plan
from agents.learning.plan_file import read_plan, read_table
from agents.statistics import interquartile_mean
from flexarm_env.errors import InputError
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import measure
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.sets import ArmSet

#: Searched options: path in a plan, lowest and highest value; all on a logarithmic scale.
RANGES = {
    "learning.learning_rate": (2e-4, 4e-3),
    "reward.vibration": (0.1, 3.0),
    "reward.strain_scale": (1e-3, 0.1),
    "reward.tip_scale": (0.05, 2.0),
    "reward.effort": (1e-3, 0.2),
}
#: Arms on which a trial is judged; their seeds are shifted from those of evaluation, so that tuning uses none of its arms.
JUDGES = ArmSet("judges", "as randomised, other draws", payload=True, constants=0.1, friction=0.2)
JUDGES_SEED, JUDGES_COUNT = 900_000_000, 50


def changed(plan: Plan, values: Mapping[str, float]) -> Plan:
    """Replace the values at some paths of a plan."""
    table = plan.table()
    for path, value in values.items():
        section, key = path.split(".")
        table[section][key] = value
    return read_table(table)


def score_of(plan: Plan, seed: int) -> float:
    """Train once and return the mean logarithm of the interquartile means of the goals' measures: less is better."""
    from agents.learning.run import train

    made = train(plan, seed, None, lambda share, text: None)
    seen = roll_out(made.agent(), TASKS[plan.task], made.arm, JUDGES, JUDGES_COUNT, first_seed=JUDGES_SEED)
    found = measure(seen, TASKS[plan.task])
    return float(np.mean([np.log(max(interquartile_mean(found[name]), 1e-6)) for name in GOALS]))


def open_study(storage: Path, name: str) -> Any:
    """Open the study of a name: a new one, or one shared with other processes and machines through the file."""
    import optuna
    from optuna.storages import JournalStorage
    from optuna.storages.journal import JournalFileBackend

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    return optuna.create_study(
        study_name=name, storage=JournalStorage(JournalFileBackend(str(storage))), load_if_exists=True, direction="minimize"
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Try some plans, print the best one's options, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.tune", description=__doc__)
    parser.add_argument("config", type=Path, help="TOML file to start from")
    parser.add_argument("--storage", type=Path, required=True, help="journal file; who shares it shares the search")
    parser.add_argument("--trials", type=int, default=20, help="for this process; 20 by default")
    parser.add_argument("--actions", type=int, default=4_000_000, help="in each trial; 4 million by default")
    asked = parser.parse_args(arguments)
    try:
        plan = changed_length(read_plan(asked.config), asked.actions)
        if asked.trials < 1:
            raise InputError(f"--trials {asked.trials}; give a whole number from 1 up")
        if not asked.storage.parent.is_dir():
            raise InputError(f"--storage {asked.storage}: there is no folder {asked.storage.parent}; make it first")
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    study = open_study(asked.storage, asked.config.stem)

    def objective(trial: Any) -> float:
        values = {path: trial.suggest_float(path, low, high, log=True) for path, (low, high) in RANGES.items()}
        score = score_of(changed(plan, values), trial.number)
        print(f"trial {trial.number}: {score:.3f}", file=sys.stderr)
        return score

    try:
        study.optimize(objective, n_trials=asked.trials)
    except KeyboardInterrupt:
        print("stopped; the same command goes on", file=sys.stderr)
        return 130
    print(f"best of {len(study.trials)}: {study.best_value:.3f}")
    for path, value in study.best_params.items():
        print(f"{path} = {value:.4g}")
    return 0


def changed_length(plan: Plan, actions: int) -> Plan:
    """Replace the number of actions of a plan."""
    return read_table(plan.table() | {"actions": actions})


if __name__ == "__main__":
    sys.exit(main())
