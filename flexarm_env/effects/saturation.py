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
    parameters: ClassVar = {
        "limit": Parameter("", 0.0, math.inf, 3.0, null=math.inf, meaning="largest output [A or V]", of_command=True)
    }
    looks_like = "the answer to large commands is cut off, to small ones right"
    confused_with = ("rate_limit", "current_lag")

    @staticmethod
    def drive(command, limit):
        """Command within ±limit."""
        return min(max(command, -limit), limit)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Limits that cut off the peaks of commands of 5 A, some much, some little: above them there is no slope to follow."""
        return [{"limit": limit} for limit in (4.5, 4.85, 4.0, 3.5, 3.0, 2.5)]
