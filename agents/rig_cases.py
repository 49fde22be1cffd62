"""Machines of the independent simulator: what the nominal arm has of each, and what is hidden in it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tests.rig.settings import GRAVITY

PROJECT = Path(__file__).resolve().parent.parent
#: Mass [kg] and inertia [kg m²] of a rigid link of 1 m, as in the files of its arms, and a mass at its end [kg].
LINK_MASS, LINK_INERTIA, PAYLOAD = 0.42381, 0.14256, 0.2
#: Torque of 1 kg at that end about an axis that leans by 0.25 rad [Nm].
TORQUE_PER_MASS = GRAVITY * math.sin(0.25)
ARMS = PROJECT / "configs" / "agents" / "rig" / "arms"


@dataclass(frozen=True)
class Case:
    """A machine, and the arm that lacks what is hidden in it.

    Attributes:
        hidden: settings of tests.rig.
        effect: of the catalogue, that is hidden.
        nominal: file of the nominal arm.
        known: settings of tests.rig that the nominal arm has, where it is not the rig's own.
    """

    hidden: Mapping[str, float]
    effect: str
    nominal: Path = PROJECT / "configs" / "arms" / "thesis-fem.toml"
    known: Mapping[str, float] = field(default_factory=dict)

    @property
    def settings(self) -> dict[str, float]:
        """All settings of the machine."""
        return {**self.known, **self.hidden}


CASES: Mapping[str, Case] = {
    "cable": Case({"cable": 0.15}, "cable_stiffness"),
    "dead-zone": Case({"dead": 0.4}, "dead_zone"),
    "bias": Case({"bias": 0.15}, "constant_torque"),
    "lag": Case({"lag": 0.02}, "current_lag"),
    "payload": Case(
        {"jh": LINK_INERTIA + PAYLOAD, "weight": TORQUE_PER_MASS * (LINK_MASS / 2.0 + PAYLOAD)},
        "payload",
        ARMS / "leaning-link.toml",
        {"elements": 0, "jh": LINK_INERTIA, "weight": TORQUE_PER_MASS * LINK_MASS / 2.0},
    ),
    "soft-gears": Case(
        {"gearc": 60.0, "mesh_c": 0.1}, "gear_compliance", ARMS / "rigid-link.toml", {"elements": 0, "jh": LINK_INERTIA}
    ),
}


def arm_files(case: str, folder: Path) -> dict[str, Path]:
    """Locate the nominal arm of a case, and the one that a diagnosis has corrected, below a folder of results."""
    return {"nominal": CASES[case].nominal, "corrected": folder / "arms" / f"{case}.toml"}
