"""Viscous friction of a lubricant that thins as it is sheared: it flattens with speed."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class ShearThinning(Effect):
    """Viscous friction of a lubricant that thins as it is sheared: it flattens with speed."""

    name = "shear_thinning"
    equation = "T = b ω / √(1 + |ω|/ω₀)"
    parameters: ClassVar = {
        "coefficient": Parameter("N*m*s", 0.0, 1e5, 0.05, null=0.0, meaning="b, friction per speed at rest"),
        "knee": Parameter("rad/s", 1e-6, 1e3, 0.5, meaning="ω₀, speed from which friction grows as the root of the speed"),
    }
    looks_like = (
        "friction grows with speed, but less and less: viscous friction is too low at low speed and too high at high speed"
    )
    confused_with = ("viscous", "coulomb", "stribeck")
    source = "Mamedov and Mikhel, Front. Robot. AI 7 (2020) 48: friction in proportion to the root of the speed"
    modifies = "viscous"
    varies = True
    motor_share = "motor_viscous_share"

    @staticmethod
    def friction(speed, coefficient, knee):
        """B ω / √(1 + ω/ω₀)."""
        return coefficient * speed / math.sqrt(1.0 + speed / knee)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """An early and a late knee."""
        return [{"coefficient": 0.2, "knee": 0.1}, {"coefficient": 0.05, "knee": 1.0}]
