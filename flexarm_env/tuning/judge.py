"""The score of a controller or policy in a search: on arms that no evaluation sees, with robustness among them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.tasks import CONTROL_RATE, TASKS
from flexarm_env.trials.measures import measure
from flexarm_env.trials.rollout import Agent, roll_out
from flexarm_env.trials.score import cost, worst_tenth
from flexarm_env.trials.sets import ROBUSTNESS, SEARCH_SEED
from flexarm_env.vector_env import FlexArmVectorEnv

#: A task and a set of arms.
Cell = tuple[str, str]
#: Tasks and sets of arms of a score. Play of the gears and lost sensors are left for the evaluation.
CELLS: tuple[Cell, ...] = (
    ("slew", "randomised"),
    ("slew", "delay_5ms"),
    ("slew", "delay_10ms"),
    ("slew", "constants_30"),
    ("slew", "half_rate"),
    ("track", "randomised"),
)
#: Added to the cost of an arm that does not settle: as much as if its measures were e² times as large.
UNSETTLED, PERCENT = 2.0, 100.0
#: Seeds of each search's arms.
SEEDS_EACH = 10_000


def cells_of(arm: Arm, count: int, seed: int, tasks: Sequence[str] = ("slew", "track")) -> list[Cell]:
    """List the cells of some tasks whose arms can be drawn around an arm.

    Raises:
        InputError: where there is none.
    """
    found, refused = [], None
    for task, name in CELLS:
        try:
            if task in tasks:
                arms = ROBUSTNESS[name]
                made = FlexArmVectorEnv(count, task, arms.machine(arm), physical=True, **arms.arguments(arm))
                made.reset(seed=first_seed(seed))
                found.append((task, name))
        except InputError as error:
            refused = error
    if not found and refused is not None:
        raise refused
    return found


def first_seed(seed: int) -> int:
    """Compute the seed of the first arm of a search's cells."""
    return SEARCH_SEED + SEEDS_EACH * seed


def score(make: Callable[[float], Agent], arm: Arm, cells: Sequence[Cell], count: int, seed: int) -> float:
    """Compute the mean of the cells' costs, less is better: of each cell half its mean, half its worst tenth.

    A cost is the mean logarithm of settling time, steady error and residual strain, so that a tenth more of one weighs as
    much as a tenth more of another. An arm that does not settle costs more than its measures say: a law that fails on one set
    should not make up for it by small gains on the others.

    Args:
        make: makes the controller or policy for a control period [s].
        arm: the nominal one.
        cells: tasks and sets of arms that count.
        count: of arms in each cell.
        seed: of the search; another one draws other arms.

    Raises:
        InputError: where the agent cannot be made for the arm.
    """
    found = []
    for task, name in cells:
        arms = ROBUSTNESS[name]
        agent = make(1.0 / (CONTROL_RATE * arms.rate_share))
        seen = roll_out(agent, TASKS[task], arm, arms, count, CONTROL_RATE, first_seed(seed))
        values = measure(seen, TASKS[task])
        costs = cost(values) + UNSETTLED * values["unsettled"] / PERCENT
        found.append(0.5 * (costs.mean() + float(worst_tenth(costs))))
    return float(np.mean(found))
