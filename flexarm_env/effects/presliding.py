"""Friction that yields like a spring before it slides."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class Presliding(Effect):
    """Friction that yields like a spring before it slides."""

    name = "presliding"
    equation = "dT/dθ = (1 − T/T_c sgn ω) / c"
    parameters: ClassVar = {"compliance": Parameter("rad/N/m", 0.0, 1e4, 2e-3, null=0.0, meaning="c, of friction at rest")}
    modifies = "coulomb"
    looks_like = "the hub rings where it should stick, and creeps back a little after it has stopped"
    confused_with = ("gear_compliance", "stiction")
    source = "Dahl, AIAA J. 14 (1976) 1675"

    @staticmethod
    def presliding(before, travel, level, compliance):
        """Relax the friction before the travel towards its level while sliding."""
        if level <= 0.0:
            return 0.0
        sliding = math.copysign(level, travel)
        # presliding within 4e-5 rad is stiffer than gears: practically rigid, and slow to integrate
        return sliding + (before - sliding) * math.exp(-abs(travel) / max(compliance * level, 4e-5))
