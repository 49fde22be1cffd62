"""Search for better options of control laws and policies: python -m agents.tune lqg mpc configs/agents/ppo_slew.toml.

A law becomes configs/controllers/NAME_tuned.toml; of a policy, the options that were found are printed. Both are judged on the
same arms, by the same score, with the same seeds. Stopped by Ctrl-C, the same command goes on.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from agents.learning.options import Plan
from agents.learning.plan_file import read_plan, read_table
from flexarm_env import Arm
from flexarm_env.arm_text import arm_text
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.tuning.judge import Cell, cells_of, score
from flexarm_env.tuning.search import Budget, study_name, tune
from flexarm_env.tuning.spaces import SPACES, Range, nested, space_of
from flexarm_env.tuning.study import Study, Values

FOLDER = Path(__file__).resolve().parent.parent / "configs" / "controllers"
#: Searched options of a policy's plan.
PLAN_SPACE = {
    "learning.learning_rate": Range(2e-4, 4e-3),
    "reward.vibration": Range(0.1, 3.0),
    "reward.strain_scale": Range(1e-3, 0.1),
    "reward.tip_scale": Range(0.05, 2.0),
    "reward.effort": Range(1e-3, 0.2),
}


def changed(plan: Plan, values: Mapping[str, float]) -> Plan:
    """Replace the values at some paths of a plan."""
    table = plan.table()
    for section, options in nested(values).items():
        table[section].update(options)
    return read_table(table)


def score_of(plan: Plan, seed: int, cells: Sequence[Cell], budget: Budget) -> float:
    """Train once, and compute the score on cells of the plan's task."""
    from agents.learning.run import train

    made = train(plan, seed, None, lambda share, text: None)
    return score(made.agent, made.arm, cells, budget.arms, budget.seed)


def tune_policy(config: Path, actions: int, budget: Budget, journal: Path | None) -> dict[str, float]:
    """Search for the options of a policy's plan; return the best ones by path.

    Args:
        config: TOML file to start from.
        actions: in the training of each trial.
        budget: of the search.
        journal: file in which trials outlast a stop; those of another configuration or arm are left alone.
    """
    plan = read_table(read_plan(config).table() | {"actions": actions})
    arm = Arm.load(plan.arm)
    cells = cells_of(arm, budget.arms, budget.seed, (plan.task,))
    name = study_name(config.stem, budget, plan.table(), arm_text(arm), cells, PLAN_SPACE)
    study = Study(name, PLAN_SPACE, journal)

    def objective(values: Values) -> float:
        return score_of(changed(plan, values), len(study.finished()), cells, budget)

    study.run(budget.trials, budget.seed, objective, report=said(config.stem, budget))
    return study.best()[0]


def said(name: str, budget: Budget) -> Callable[[int, float], None]:
    """Make the line that shows how far a search is."""

    def report(done: int, least: float) -> None:
        print(f"\r{name}: {done} of {budget.trials}, {least:.3f} ", end="", file=sys.stderr, flush=True)

    return report


@Program(stopped="stopped; with --journal, the same command goes on")
def main(arguments: Sequence[str]) -> int:
    """Search for the options of each subject, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.tune", description=__doc__.partition("\n")[0])
    parser.add_argument("subjects", nargs="+", metavar="NAME|CONFIG", help=f"of {', '.join(SPACES)}; or a policy's TOML file")
    parser.add_argument("--journal", type=Path, help="file of the trials; who shares it shares the search")
    parser.add_argument("--arm", default="thesis", help="of the control laws: name or file; thesis by default")
    parser.add_argument("--trials", type=int, default=Budget().trials, help=f"of each; {Budget().trials} by default")
    parser.add_argument("--arms", type=int, default=Budget().arms, help=f"in each cell; {Budget().arms} by default")
    parser.add_argument("--seed", type=int, default=0, help="of values and arms; 0 by default")
    parser.add_argument("--actions", type=int, default=4_000_000, help="in a trial of a policy; 4 million by default")
    parser.add_argument("--save", type=Path, default=FOLDER, help="folder of the tuned laws; configs/controllers by default")
    asked = parser.parse_args(arguments)
    budget = Budget(asked.trials, asked.arms, asked.seed)
    for subject in asked.subjects:
        if not subject.endswith(".toml"):
            space_of(subject)
            make_folder(asked.save, place_of(subject))
    for subject in asked.subjects:
        one_search(subject, asked, budget)
    return 0


def place_of(law: str) -> str:
    """Name the file of a tuned law."""
    return f"{law}_tuned.toml"


def one_search(subject: str, asked: argparse.Namespace, budget: Budget) -> None:
    """Search for the options of one law or policy, and write or print them."""
    if subject.endswith(".toml"):
        values = tune_policy(Path(subject), asked.actions, budget, asked.journal)
        print(f"\n{subject}", *(f"{path} = {value:.4g}" for path, value in values.items()), sep="\n")
        return
    found = tune(subject, Arm.load(asked.arm), budget, asked.journal, said(subject, budget))
    place = asked.save / place_of(subject)
    found.save(place)
    print(f"\n{place}: {found.search['score_before']} before, {found.search['score']} tuned")


if __name__ == "__main__":
    sys.exit(main())
