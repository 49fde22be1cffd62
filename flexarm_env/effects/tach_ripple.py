"""Ripple of the tachometer's gain once per turn of the motor, as from a misaligned shaft."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class TachRipple(Effect):
    """Ripple of the tachometer's gain once per turn of the motor, as from a misaligned shaft."""

    name = "tach_ripple"
    equation = "y = ω (1 + a sin(θ_m + φ))"
    parameters: ClassVar = {
        "amplitude": Parameter("", 0.0, 1.0, 0.05, null=0.0, meaning="a, share of the speed"),
        "phase": Parameter("rad", -6.3, 6.3, 0.0, meaning="φ, at angle zero"),
    }
    looks_like = "speed alone is off by a share that repeats with the motor's turns; angle and strain fit"
    confused_with = ("tach_filter",)
    needs = ("motor_speed",)
    reads = ("motor_speed",)

    @staticmethod
    def sensor(reading, motor_angle, amplitude, phase):
        """ω (1 + a sin(θ_m + φ))."""
        return reading * (1.0 + amplitude * math.sin(motor_angle + phase))

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Two phases; the opposite ones act with the opposite sign."""
        return [{"amplitude": 0.05, "phase": phase} for phase in (0.0, 1.57)]
