"""Gears, belt or coupling that wind up under torque."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class GearCompliance(Effect):
    """Gears, belt or coupling that wind up under torque."""

    name = "gear_compliance"
    equation = "τ = k (θ_m/N − θ)"
    parameters: ClassVar = {"stiffness": Parameter("N*m/rad", 1.0, math.inf, 200.0, null=math.inf, meaning="k, arm side")}
    looks_like = "motor speed leads the arm by a fast vibration of its own"
    confused_with = ("backlash", "root_compliance", "higher_modes")
    source = "Spong, J. Dyn. Syst. Meas. Control 109 (1987) 310"
    needs = ("motor_speed", "motor_inertia")

    @staticmethod
    def structure(structure: Structure, stiffness: float) -> None:
        """Put a spring between motor and hub, in place of stiffer gears."""
        structure.gear_compliance = max(structure.gear_compliance, 1.0 / stiffness)
