"""A spring of joint or gears that stiffens with its windup."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class Stiffening(Effect):
    """A spring of joint or gears that stiffens with its windup, as strain wave gears do."""

    name = "stiffening"
    equation = "τ = k ε (1 + (ε/ε₀)²)"
    parameters: ClassVar = {
        "knee": Parameter("rad", 1e-4, math.inf, 0.1, null=math.inf, meaning="ε₀, windup at which the torque has doubled"),
    }
    looks_like = "large vibrations of the joint are faster than small ones"
    confused_with = ("gear_compliance", "backlash")
    source = "Tuttle and Seering, IEEE Trans. Robot. Autom. 12 (1996) 368"
    needs = ("soft_gears",)

    @staticmethod
    def spring(windup, stiffness, knee):
        """K ε (ε/ε₀)²."""
        return stiffness * windup * (windup / knee) * (windup / knee)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Springs that stiffen early and late."""
        return [{"knee": knee} for knee in (0.01, 0.1, 0.5)]
