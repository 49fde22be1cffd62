"""Extra friction at rest, gone once the hub moves."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class Stiction(Effect):
    """Extra friction at rest, gone once the hub moves."""

    name = "stiction"
    equation = "T ≤ T_c + extra at ω = 0"
    parameters: ClassVar = {
        "extra": Parameter("N*m", 0.0, 1e4, 0.05, null=0.0, spread=0.5, meaning="static less sliding friction, arm side")
    }
    modifies = "coulomb"
    looks_like = "the hub breaks away later than sliding friction predicts, and then jumps"
    confused_with = ("stribeck", "coulomb", "dead_zone")
    source = "thesis section 2.2 and Table A.1"
    motor_share = "motor_stiction_share"

    @staticmethod
    def friction(at_rest, extra):
        """Extra at rest, 0 while it turns."""
        if at_rest:
            return extra
        return 0.0
