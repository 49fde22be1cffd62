"""Compliance of gears, belt or coupling under torque."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class GearCompliance(Effect):
    """Compliance of gears, belt or coupling under torque."""

    name = "gear_compliance"
    equation = "τ = k (ε + T dε/dt), ε = θ_m/N − θ"
    parameters: ClassVar = {
        "stiffness": Parameter("N*m/rad", 1e-6, math.inf, 200.0, null=math.inf, meaning="k, arm side"),
        "damping_time": Parameter("s", 1e-6, 1.0, 5e-4, meaning="T, damping of the windup over k"),
    }
    looks_like = "motor speed shows a fast vibration against the arm"
    confused_with = ("backlash", "beam_damping", "root_compliance", "higher_modes")
    source = "Spong, J. Dyn. Syst. Meas. Control 109 (1987) 310"
    needs = ("windup", "motor_inertia", "hub_inertia")

    @staticmethod
    def structure(structure: Structure, stiffness: float, damping_time: float) -> None:
        """Put a damped spring between motor and hub, in place of stiffer gears."""
        if 1.0 / stiffness > structure.gear_compliance:
            structure.gear_compliance, structure.gear_damping_time = 1.0 / stiffness, damping_time

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Weakly and strongly damped gears."""
        return [{"stiffness": 200.0, "damping_time": time} for time in (5e-4, 5e-3)]
