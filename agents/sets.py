"""The fixed sets of arms for evaluation: the same draws for every controller and policy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.wrappers.arms import drawn_values

#: Seed of the first arm of a set; training uses seeds below it.
FIRST_SEED = 1_000_000_000


@dataclass(frozen=True)
class ArmSet:
    """Differences from arm to arm.

    Attributes:
        name: of the set.
        meaning: one line for a person.
        payload: whether a tip mass of 0 to 0.3 kg is drawn.
        constants: share by which torque constant, inertia, mass and stiffness differ.
        friction: share by which the friction that the arm has differs.
        disturb: taps and drop-outs.
    """

    name: str
    meaning: str
    payload: bool = False
    constants: float = 0.0
    friction: float = 0.0
    disturb: Mapping[str, float] = field(default_factory=dict)

    def arguments(self, arm: Arm) -> dict[str, Any]:
        """Make the arguments of an environment with arms drawn from the set."""
        return drawn_values(arm, self.payload, self.constants, self.friction) | {"disturb": dict(self.disturb)}


SETS = {
    found.name: found
    for found in (
        ArmSet("nominal", "the arm as it is in its file; only the sensors' noise differs"),
        ArmSet("randomised", "payload 0 to 0.3 kg, constants ±10 %, friction ±20 %", payload=True, constants=0.1, friction=0.2),
        ArmSet(
            "disturbed",
            "taps on the hub, one a second, up to 0.5 Nm for 20 ms; sensors that drop out for 50 ms, two a second",
            disturb={"tap_rate": 1.0, "tap_torque": 0.5, "tap_time": 0.02, "dropout_rate": 2.0, "dropout_time": 0.05},
        ),
    )
}
