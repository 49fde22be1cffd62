"""An amplifier that gives no more than a limit."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class Saturation(Effect):
    """An amplifier that gives no more than a limit."""

    name = "saturation"
    equation = "i = min(max(command, −limit), limit)"
    parameters: ClassVar = {"limit": Parameter("", 0.0, math.inf, 3.0, null=math.inf, meaning="largest output [A or V]")}
    looks_like = "the answer to large commands is cut off, to small ones right"
    confused_with = ("rate_limit", "current_lag")

    @staticmethod
    def drive(command, limit):
        """Command within ±limit."""
        return min(max(command, -limit), limit)
