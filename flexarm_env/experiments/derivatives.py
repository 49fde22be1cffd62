"""Derivatives of an arm's readings with respect to its constants and the parameters of its effects."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.plant.plant import Plant
from flexarm_env.plant.tangents.constants import PLACES, Neighbours, constant_tangents
from flexarm_env.plant.tangents.tangents import Tangents

#: Step between arms whose constants are differenced, over the value.
STEP = 1e-3
#: Constants of an arm file that are no quantities of its motion, or count something.
NOT_SMOOTH = ("drive.limit", "drive.torque_noise", "beam.elements")
NOT_SMOOTH_OF_SENSORS = ("noise", "resolution", "delay", "per_volt")


def full_path(arm: Arm, name: str) -> str:
    """Complete the name of a constant, as "beam.length" or "coulomb.torque", to its path in the arm.

    Raises:
        InputError: for a value that the arm does not have, or on which its readings do not depend smoothly.
    """
    known = [f"{section}.{key}" for section, table in arm.constants.items() for key in table]
    known += [f"sensors.{signal}.{key}" for signal, table in arm.sensors.items() for key in table]
    effects = [f"{effect}.{key}" for effect, table in arm.effects.items() for key in table]
    path = f"effects.{name}" if name in effects else name
    if path not in known and path.removeprefix("effects.") not in effects:
        raise InputError(f"arm '{arm.name}' has no constant '{name}'{did_you_mean(name, [*known, *effects])}")
    section, *rest = path.split(".")
    smooth = path not in NOT_SMOOTH and not (section == "sensors" and rest[1] in NOT_SMOOTH_OF_SENSORS)
    if section == "effects":
        effect, values = arm.known[rest[0]], arm.effects[rest[0]]
        if effect.absent(values):
            raise InputError(f"{name} = {arm.value(path):g} means that the effect is absent: give it a size, or leave it out")
        smooth = effect.fitted
    if not smooth:
        raise InputError(f"the readings have no derivative by {name}: leave it out")
    return path


def tangents_of(arm: Arm, plant: Plant, paths: Sequence[str]) -> Tangents:
    """Prepare the derivatives of an arm's readings.

    Args:
        arm: the model.
        plant: the same, compiled.
        paths: of constants and parameters, as "beam.length", "effects.coulomb.torque".

    Raises:
        InputError: for a value at which the arm changes its kind, as a filter of no length, and for an arm whose drive's torque
            depends on the motion, or with a nonlinear spring.
    """
    if arm.input == "position" or arm.structure().has_limits:
        raise InputError(
            f"arm '{arm.name}' has a servo or a supply that sags, by which there are no derivatives: take differences"
        )
    if any(law.port == "spring" for law in arm.laws()):
        raise InputError(f"arm '{arm.name}' has a spring that is not linear, by which there are no derivatives: take differences")
    scales = np.array([_scale(arm, path) for path in paths])
    beside = [
        arm.with_values({path: arm.value(path) + STEP * scale * place})
        for path, scale in zip(paths, scales, strict=True)
        for place in PLACES
    ]
    neighbours = Neighbours([a.structure() for a in beside], [a.laws() for a in beside], STEP * scales)
    try:
        constants = constant_tangents(arm.structure(), arm.laws(), plant.interval, neighbours)
    except ValueError:
        values = ", ".join(f"{path} = {arm.value(path):g}" for path in paths)
        raise InputError(f"the readings have no derivative by one of {values}, at which the arm changes its kind") from None
    return Tangents(plant, constants, scales)


def _scale(arm: Arm, path: str) -> float:
    """Size of a value for differences: its own, or its typical one where it is zero."""
    return abs(arm.value(path)) or abs(arm.parameter(path).typical) or 1.0
