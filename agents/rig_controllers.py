"""Controllers for the machine: made and tuned for the nominal arm, and for a corrected one."""

from __future__ import annotations

from pathlib import Path

from flexarm_env import Arm
from flexarm_env.controllers.tuned import shipped_controllers
from flexarm_env.tuning.search import Budget, tune

NOMINAL = "thesis-fem"
CLASSICAL = ("pd", "vibration_dual", "shaped_zvd", "lqg")
#: Laws that are tuned anew on the nominal arm and on each corrected arm, and the budget of each search; every one starts from
#: the shipped values of its law.
RETUNED = ("pd", "lqg", "pid_compensated")
RETUNING = Budget(trials=25, arms=8)


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


def controllers_of(folder: Path, case: str) -> dict[str, tuple[str | Path, Arm]]:
    """List laws, and their tuned controllers where stored, each with its arm: the nominal one and a case's corrected one."""
    arms = {"nominal": (Arm.load(NOMINAL), "nominal"), "corrected": (Arm.load(folder / "arms" / f"{case}.toml"), case)}
    found: dict[str, tuple[str | Path, Arm]] = {}
    for law in dict.fromkeys((*CLASSICAL, *RETUNED)):
        for kind, (arm, name) in arms.items():
            place = tuned_place(folder, law, name)
            if law in CLASSICAL:
                found[f"{law}, {kind}"] = law, arm
            if place.is_file():
                found[f"{law} tuned, {kind}"] = place, arm
    return found
