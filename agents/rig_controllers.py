"""Controllers for the machine: made and tuned for the nominal arm and for a corrected one, and the choice between both."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from agents.evaluate import RATE
from agents.rig_cases import arm_files
from flexarm_env import Arm, InputError
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.tuned import shipped_controllers
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import measure
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.score import cost
from flexarm_env.trials.sets import DEVELOPMENT_SEED, SETS
from flexarm_env.tuning.search import Budget, tune

CLASSICAL = ("pd", "vibration_dual", "shaped_zvd", "lqg")
#: Laws that are tuned anew on each nominal arm and on each corrected arm, and the budget of each search; every one starts from
#: the shipped values of its law.
RETUNED = ("pd", "lqg", "pid_compensated")
RETUNING = Budget(trials=25, arms=8)
#: Kinds of controllers of a law: designed or tuned for which arm. The first of equally good ones is chosen.
KINDS = ("nominal", "corrected")
#: Episodes of the corrected arm's simulation by which one of two controllers is chosen.
REHEARSALS = 8


def tuned_place(folder: Path, law: str, arm: Path) -> Path:
    """Locate the controller of a law that is tuned for the arm of a file: a nominal one, or a case's corrected one."""
    return folder / "controllers" / f"{law}-{arm.stem}.toml"


def retune(law: str, arm: Arm, place: Path) -> None:
    """Tune a law on an arm from the shipped values, and write the controller; a stopped search goes on."""
    place.parent.mkdir(parents=True, exist_ok=True)
    journal = place.with_suffix(".journal")
    tune(law, arm, RETUNING, journal, start=shipped_controllers()[f"{law}_tuned"]).save(place)
    for left in (journal, journal.with_name(journal.name + ".lock")):
        left.unlink(missing_ok=True)


def controllers_of(folder: Path, case: str) -> dict[str, tuple[str | Path, Arm]]:
    """List laws, and their tuned controllers where stored, each with its arm: the nominal one and a case's corrected one.

    A law that cannot be made for a machine is left out: there is none against vibration without a beam.
    """
    found: dict[str, tuple[str | Path, Arm]] = {}
    arms = {kind: (place, Arm.load(place)) for kind, place in arm_files(case, folder).items()}
    for law in dict.fromkeys((*CLASSICAL, *RETUNED)):
        for kind, (place, arm) in arms.items():
            tuned = tuned_place(folder, law, place)
            if law in CLASSICAL and _can_be_made(law, arm):
                found[f"{law}, {kind}"] = law, arm
            if tuned.is_file():
                found[f"{law} tuned, {kind}"] = tuned, arm
    return found


def _can_be_made(law: str, arm: Arm) -> bool:
    try:
        make_controller(law, arm, 1.0 / RATE)
    except InputError:
        return False
    return True


def rehearse(law: str | Path, arm: Arm, corrected: Arm) -> dict[str, np.ndarray]:
    """Let a law, or a tuned controller in a file, made for an arm, drive the corrected arm in simulation: each measure."""
    controller = make_controller(str(law), arm, 1.0 / RATE)
    return measure(
        roll_out(controller, TASKS["slew"], corrected, SETS["nominal"], REHEARSALS, RATE, DEVELOPMENT_SEED), TASKS["slew"]
    )


def chosen(rehearsed: Mapping[str, Mapping[str, np.ndarray]]) -> dict[str, str]:
    """Choose for each law, or its tuned form, the controller of less cost in simulations of the corrected arm: its kind.

    A model corrected by one effect can make a controller worse on the machine: a torque that it now takes away had helped
    another over its friction. The corrected arm's simulation shows it before the machine does.

    Args:
        rehearsed: measures (episodes,) by the name of each controller, "pd tuned, corrected".
    """
    costs = {name: float(cost(found).mean()) for name, found in rehearsed.items()}
    laws = dict.fromkeys(name.rpartition(", ")[0] for name in costs)
    both = [law for law in laws if all(f"{law}, {kind}" in costs for kind in KINDS)]
    return {law: min(KINDS, key=lambda kind: costs[f"{law}, {kind}"]) for law in both}
