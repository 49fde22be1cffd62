"""Error of the transmission in strain wave gears: twice per turn of the wave generator."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class KinematicError(Effect):
    """Error of the transmission in strain wave gears: twice per turn of the wave generator, which is the motor's shaft."""

    name = "kinematic_error"
    equation = "ε = θ_m/N + a sin(2 θ_m + φ) − θ"
    parameters: ClassVar = {
        "amplitude": Parameter("rad", 0.0, 0.1, 1e-3, null=0.0, meaning="a, arm side"),
        "phase": Parameter("rad", -6.3, 6.3, 0.0, meaning="φ, at angle zero"),
    }
    looks_like = "the arm trembles twice per turn of the motor, most where that meets a resonance"
    confused_with = ("cogging", "gear_compliance", "tach_ripple")
    source = "Tuttle and Seering, IEEE Trans. Robot. Autom. 12 (1996) 368"
    scan_phase = "phase"
    needs = ("soft_gears",)

    @staticmethod
    def spring(motor_angle, stiffness, amplitude, phase):
        """K a sin(2 θ_m + φ)."""
        return stiffness * amplitude * math.sin(2.0 * motor_angle + phase)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Two phases; the opposite ones act with the opposite sign."""
        return [{"amplitude": 1e-3, "phase": phase} for phase in (0.0, 1.57)]
