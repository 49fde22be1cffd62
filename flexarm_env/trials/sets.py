"""The fixed sets of arms for evaluation: the same draws for every controller and policy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.wrappers.arms import drawn_values

#: Seed of the first arm of a set in published figures; training, searches and development use seeds below it.
FIRST_SEED = 1_000_000_000
#: The same of the arms on which choices of design are judged, and of those on which a search judges its trials.
DEVELOPMENT_SEED, SEARCH_SEED = 800_000_000, 900_000_000


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
        effects: that every machine has and the nominal arm lacks: {"input_delay": {"delay": 0.005}}.
        rate_share: share of the usual control rate.
        lost: signals that read 0 throughout, as from a broken wire.
    """

    name: str
    meaning: str
    payload: bool = False
    constants: float = 0.0
    friction: float = 0.0
    disturb: Mapping[str, float] = field(default_factory=dict)
    effects: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    rate_share: float = 1.0
    lost: tuple[str, ...] = ()

    def machine(self, arm: Arm) -> Arm:
        """Add the set's effects to the nominal arm."""
        for name, values in self.effects.items():
            arm = arm.with_effect(name, **values)
        return arm

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

RANDOMISED = SETS["randomised"]
#: The randomised arms, each set with one thing more that neither controllers nor policies have been told, but for the rate.
ROBUSTNESS = {
    found.name: found
    for found in (
        RANDOMISED,
        *(
            replace(
                RANDOMISED,
                name=f"delay_{1000.0 * delay:g}ms",
                meaning=f"commands late by {1000.0 * delay:g} ms",
                effects={"input_delay": {"delay": delay}},
            )
            for delay in (0.0025, 0.005, 0.01)
        ),
        replace(RANDOMISED, name="constants_30", meaning="constants and friction ±30 %", constants=0.3, friction=0.3),
        replace(RANDOMISED, name="backlash", meaning="play of 0.03 rad at the motor", effects={"backlash": {"gap": 0.03}}),
        replace(RANDOMISED, name="half_rate", meaning="half the control rate", rate_share=0.5),
        replace(RANDOMISED, name="gage_lost", meaning="the gage at the base reads 0", lost=("strain_base",)),
        replace(RANDOMISED, name="tach_lost", meaning="the tachometer reads 0", lost=("motor_speed",)),
    )
}
