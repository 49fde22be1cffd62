"""The constants of a machine: those of its model, each off within its prior."""

from __future__ import annotations

import copy
import math
from collections.abc import Collection, Mapping
from dataclasses import replace

from benchmarks.machines.model import Model, Rng

#: Largest standard deviation of a machine's constant about the model's, as a logarithm, and over that of the prior; the same
#: of a friction, whose prior is wide, and of an angle [rad].
MOST, SHARE, FRICTION, TURN = 0.04, 1.0 / 3.0, 0.1, 0.03
#: The rig has these exact.
EXACT = ("sensors.arm_angle.gain", "sensors.motor_speed.gain", "sensors.tip_deflection.gain")


def spreads(model: Model, exact: Collection[str] = EXACT) -> dict[str, float]:
    """Find the standard deviation that a fit assumes of each constant, as a logarithm; values without a prior are left out.

    Args:
        model: with the constants.
        exact: constants that are left out, too.
    """
    arm = model.arm
    one_body = model.values["drive.gear_stiffness"] == 0.0
    found = {}
    for path, value in model.values.items():
        spread = arm.parameter(path).spread
        split = path.startswith("drive.motor_") and path.endswith("_share")
        if value > 0.0 and 0.0 < spread < math.inf and path not in arm.fixed and path not in exact and not (split and one_body):
            found[path] = spread
    return found


def drawn(draw: Rng, model: Model) -> Model:
    """Draw a machine whose constants differ from those of the model."""
    values = {}
    for path, spread in spreads(model).items():
        deviation = FRICTION if path.startswith("effects.") else min(MOST, SHARE * spread)
        values[path] = model.values[path] * math.exp(deviation * draw.standard_normal())
    if "effects.base_tilt.torque" in model.values:
        values["effects.base_tilt.torque"] = model.values["effects.base_tilt.torque"] * math.exp(MOST * draw.standard_normal())
        values["effects.base_tilt.uphill"] = model.values["effects.base_tilt.uphill"] + TURN * draw.standard_normal()
    return with_values(model, values)


def with_values(model: Model, values: Mapping[str, float]) -> Model:
    """Replace values of a model, by their paths."""
    table = copy.deepcopy(dict(model.table))
    for path, value in values.items():
        *sections, key = path.split(".")
        place = table
        for section in sections:
            place = place.setdefault(section, {})
        place[key] = float(value)
    return replace(model, table=table)
