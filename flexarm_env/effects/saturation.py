"""Limit on the amplifier's output."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class Saturation(Effect):
    """Limit on the amplifier's output."""

    name = "saturation"
    equation = "i = min(max(command, −limit), limit)"
    parameters: ClassVar = {
        "limit": Parameter("", 0.0, math.inf, 3.0, null=math.inf, meaning="largest output [A or V]", of_command=True)
    }
    looks_like = "the response to large commands is cut off, to small ones right"
    confused_with = ("rate_limit", "current_lag")

    @staticmethod
    def drive(command, limit):
        """Command within ±limit."""
        return min(max(command, -limit), limit)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Limits from slightly to far below peaks of 5 A: above the peaks the error has no gradient."""
        return [{"limit": limit} for limit in (4.5, 4.85, 4.0, 3.5, 3.0, 2.5)]
