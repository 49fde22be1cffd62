"""Arms to train on: how they differ from episode to episode, and from share to share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.wrappers.options import ArmsOptions

FRICTION = {"viscous": "coefficient", "coulomb": "torque", "stiction": "extra"}
CONSTANTS = ("drive.torque_constant", "hub.inertia", "beam.mass_per_length", "beam.bending_stiffness")
#: Narrowest gap of a backlash that is drawn, over the widest: without any gap the gears would be another kind.
LEAST_SHARE = 0.01
#: Lowest and highest tip mass [kg].
PAYLOAD = (0.0, 0.3)


def draws_of(options: ArmsOptions, arm: Arm) -> dict[str, Any]:
    """Make the arguments of an environment whose arms are drawn by the options: randomise, vary, disturb."""
    given = drawn_values(arm, options.payload, options.constants, options.friction)
    if options.backlash:
        given["randomise"]["backlash.gap"] = (LEAST_SHARE * options.backlash, options.backlash)
    return given | {"disturb": {"tap_rate": options.tap_rate, "dropout_rate": options.dropout_rate}}


def drawn_values(arm: Arm, payload: bool, constants: float, friction: float) -> dict[str, dict[str, Any]]:
    """Make the arguments randomise and vary of an environment.

    Args:
        arm: the nominal one; what it lacks is not drawn.
        payload: whether a tip mass is drawn.
        constants: share by which torque constant, inertia, mass and stiffness differ.
        friction: share by which the friction that the arm has differs.
    """
    vary = {path: constants for path in CONSTANTS if constants and _has(arm.constants, path)}
    vary |= {f"{name}.{key}": friction for name, key in FRICTION.items() if friction and name in arm.effects}
    return {"randomise": {"payload.mass": PAYLOAD} if payload and arm.can_have("payload") else {}, "vary": vary}


def arms_of(options: ArmsOptions, arm: Arm) -> list[Arm]:
    """List the arm with each of the options' delays, or the arm alone where there is none."""
    return [arm.with_effect("input_delay", delay=delay) if delay else arm for delay in options.delays or (0.0,)]


def _has(constants: Mapping[str, Mapping[str, float]], path: str) -> bool:
    section, key = path.split(".")
    return constants.get(section, {}).get(key, 0.0) > 0.0
