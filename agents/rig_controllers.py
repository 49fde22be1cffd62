"""Controllers for the machine: made and tuned for the nominal arm and for a corrected one, and the better of both."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from agents.evaluate import RATE
from flexarm_env import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.tuned import shipped_controllers
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import measure
from flexarm_env.trials.rollout import Agent, roll_out
from flexarm_env.trials.score import cost
from flexarm_env.trials.sets import DEVELOPMENT_SEED, SETS
from flexarm_env.tuning.search import Budget, tune

NOMINAL = "thesis-fem"
CLASSICAL = ("pd", "vibration_dual", "shaped_zvd", "lqg")
#: Laws that are tuned anew on the nominal arm and on each corrected arm, and the budget of each search; every one starts from
#: the shipped values of its law.
RETUNED = ("pd", "lqg", "pid_compensated")
RETUNING = Budget(trials=25, arms=8)
#: Episodes of the corrected arm's simulation by which one of two controllers is chosen.
REHEARSALS = 8


def tuned_place(folder: Path, law: str, kind: str) -> Path:
    """Locate the controller of a law that is tuned for the nominal arm or for a case's corrected one."""
    return folder / "controllers" / f"{law}-{kind}.toml"


def retune(law: str, arm: Arm, place: Path) -> None:
    """Tune a law on an arm from the shipped values, and write the controller; a stopped search goes on."""
    place.parent.mkdir(parents=True, exist_ok=True)
    journal = place.with_suffix(".journal")
    tune(law, arm, RETUNING, journal, start=shipped_controllers()[f"{law}_tuned"]).save(place)
    for left in (journal, journal.with_name(journal.name + ".lock")):
        left.unlink(missing_ok=True)


def controllers_of(folder: Path, case: str) -> dict[str, list[Any]]:
    """Make the controllers of the nominal arm and of a case's corrected one, and name the one chosen of both.

    As they are, and tuned where that is stored.
    """
    corrected = folder / "arms" / f"{case}.toml"
    arms = {"nominal": (NOMINAL, "nominal"), "corrected": (corrected, case)}
    makers = {law: {kind: law for kind in arms} for law in CLASSICAL}
    for law in RETUNED:
        places = {kind: tuned_place(folder, law, name) for kind, (_, name) in arms.items()}
        makers[f"{law} tuned"] = {kind: str(place) for kind, place in places.items() if place.is_file()}
    agents: dict[str, list[Any]] = {}
    for who, of_kind in makers.items():
        made = {kind: make_controller(maker, Arm.load(arms[kind][0]), 1.0 / RATE) for kind, maker in of_kind.items()}
        if len(made) == len(arms):
            made["chosen"] = better(Arm.load(corrected), list(made.values()))
        agents |= {f"{who}, {kind}": [controller] for kind, controller in made.items()}
    return agents


def better(arm: Arm, agents: Sequence[Agent]) -> Agent:
    """Choose the agent of least cost in simulations of an arm; the first of equal ones.

    A model corrected by one effect can make a controller worse on the machine: a torque that it now takes away had helped
    another over its friction. The corrected arm's simulation shows it before the machine does.
    """
    task, drawn = TASKS["slew"], SETS["nominal"]
    runs = [measure(roll_out(agent, task, arm, drawn, REHEARSALS, RATE, DEVELOPMENT_SEED), task) for agent in agents]
    costs = [float(cost(found).mean()) for found in runs]
    return agents[costs.index(min(costs))]
