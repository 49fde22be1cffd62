"""Limit on the amplifier's output."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter

#: Largest command of a recording of the typical size [A or V].
PEAK = 5.0


class Saturation(Effect):
    """Limit on the amplifier's output."""

    name = "saturation"
    equation = "i = min(max(command, −limit), limit)"
    parameters: ClassVar = {
        "limit": Parameter("", 0.0, math.inf, 3.0, null=math.inf, onset=PEAK, meaning="largest output [A or V]", of_command=True)
    }
    looks_like = "the response to large commands is cut off, to small ones right"
    confused_with = ("rate_limit", "current_lag")

    @staticmethod
    def drive(command, limit):
        """Command within ±limit."""
        return min(max(command, -limit), limit)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Limits from slightly to far below the peaks: above them the error has no gradient."""
        return [{"limit": share * PEAK} for share in (0.9, 0.97, 0.8, 0.7, 0.6, 0.5)]
