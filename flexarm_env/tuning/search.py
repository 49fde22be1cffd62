"""Tune a controller on an arm: one search with one budget for every law."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from flexarm_env import __version__
from flexarm_env.arm import Arm
from flexarm_env.arm_text import arm_text
from flexarm_env.controllers import CONTROLLERS, Controller, tuned_recipe
from flexarm_env.controllers.tuned import TunedController, on_drive
from flexarm_env.errors import InputError
from flexarm_env.tasks import CONTROL_RATE
from flexarm_env.tuning import judge
from flexarm_env.tuning.margins import margins_of
from flexarm_env.tuning.spaces import Range, nested, space_of
from flexarm_env.tuning.study import Study, Values

#: Score of a controller that cannot be made: no finite one is as large.
IMPOSSIBLE = 1e3
#: Added to the score of a loop that only dry friction keeps stable: as much as if all measures were e times as large.
UNSTABLE = 1.0


@dataclass(frozen=True)
class Budget:
    """Cost of a search, the same for every law.

    Attributes:
        trials: values that are tried, the law's own among them.
        arms: in each cell of a trial.
        seed: of values and arms.
    """

    trials: int = 120
    arms: int = 12
    seed: int = 0

    def __post_init__(self) -> None:
        if self.trials < 1 or self.arms < 1 or self.seed < 0:
            raise InputError(
                f"a search of {self.trials} trials, {self.arms} arms, seed {self.seed}; give at least 1 trial, 1 arm and seed 0"
            )


def tune(
    controller: str,
    arm: Arm,
    budget: Budget = Budget(),
    journal: Path | None = None,
    report: Callable[[int, float], None] | None = None,
    start: TunedController | None = None,
) -> TunedController:
    """Search for the options of a law that serve an arm best, and measure the loop's margins.

    Args:
        controller: name of the law.
        arm: nominal one, on which the law is designed and around which the arms of the trials are drawn.
        budget: of the search.
        journal: file in which trials outlast a stop.
        report: is called after each trial with their number and the least score.
        start: controller of the same law, whose values are tried first; the law's own by default.

    Raises:
        InputError: for an unknown law, a start of another one, or an arm that the law cannot drive.
    """
    space = space_of(controller)
    law(controller, arm, {})(1.0 / CONTROL_RATE)  # refuses an arm that lacks a signal before the search
    cells = judge.cells_of(arm, budget.arms, budget.seed)

    def objective(values: Values) -> float:
        options = nested(values)
        try:
            found = judge.score(law(controller, arm, options), arm, cells, budget.arms, budget.seed)
        except InputError:
            return IMPOSSIBLE
        return found if measured_margins(controller, arm, options) else found + UNSTABLE

    first = first_values(controller, arm, space, start)
    study = Study(study_name(controller, budget, arm_text(arm), first, cells, space), space, journal)
    study.run(budget.trials, budget.seed, objective, first, report)
    values, least = study.best()
    options = nested({name: float(f"{value:.4g}") for name, value in values.items()})
    about = asdict(budget) | {
        "episodes": budget.trials * budget.arms * len(cells),
        "cells": [f"{task} {name}" for task, name in cells],
        "score": round(least, 4),
        "score_before": round(study.finished()[0].value, 4),
    }
    return TunedController(controller, arm.name, __version__, options, about, measured_margins(controller, arm, options))


def study_name(subject: str, budget: Budget, *depends_on: object) -> str:
    """Name the study of a subject in a journal, so that only searches whose trials have the same scores share them.

    Args:
        subject: law or policy.
        budget: of the search; the number of trials is left out.
        depends_on: all else on which the score of a trial depends, as text or values with a repr.
    """
    digest = hashlib.sha256(" ".join(map(str, depends_on)).encode()).hexdigest()[:12]
    return f"{subject} {digest} {budget.arms} {budget.seed}"


def measured_margins(controller: str, arm: Arm, options: Mapping[str, Any]) -> dict[str, float]:
    """Measure the margins of a law with options on an arm, by name; nothing where the moving arm's loop is not stable."""
    try:
        return margins_of(lambda model: law(controller, model, options)(1.0 / CONTROL_RATE), arm).table()
    except InputError:
        return {}


def law(controller: str, arm: Arm, options: Mapping[str, Any]) -> Callable[[float], Controller]:
    """Prepare a law with options for the thesis's drive: a function of the control period [s]."""
    recipe = CONTROLLERS[controller]
    return lambda interval: recipe.build(arm, interval, **{**recipe.options, **on_drive(arm, options)})


def first_values(controller: str, arm: Arm, space: Mapping[str, Range], start: TunedController | None = None) -> dict[str, float]:
    """Look up the values of a start, or those that a law has by itself, moved into the search's ranges.

    Raises:
        InputError: for a start of another law.
    """
    if start is not None and start.controller != controller:
        raise InputError(f"a search of {controller} cannot start from {start.controller}; name a file of {controller}")
    if start is not None:
        tuned_recipe(start)  # refuses options that the law does not have
    made = law(controller, arm, start.options if start is not None else {})(1.0 / CONTROL_RATE)
    found = {}
    for path, ends in space.items():
        table, _, name = path.rpartition(".")
        value = getattr(made.design if table else made, name) / on_drive(arm, {name: 1.0})[name]  # type: ignore[attr-defined]
        found[path] = min(max(float(value), ends.low), ends.high)
    return found
