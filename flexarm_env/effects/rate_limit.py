"""Limit on the rate of change of the amplifier's output."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class RateLimit(Effect):
    """Limit on the rate of change of the amplifier's output."""

    name = "rate_limit"
    equation = "|di/dt| ≤ r"
    parameters: ClassVar = {
        "rate": Parameter("1/s", 0.0, math.inf, 200.0, null=math.inf, meaning="r, in A/s or V/s", of_command=True)
    }
    looks_like = "steps of the command become ramps, small changes pass unchanged"
    confused_with = ("current_lag", "saturation")
    source = "thesis section 2.3"

    @staticmethod
    def drive(command, previous, interval, rate):
        """The command, at most r·interval from the one before."""
        return min(max(command, previous - rate * interval), previous + rate * interval)

    @staticmethod
    def ramp(command, previous, start, end, rate):
        """The mean from start to end of a ramp at the rate that began at 0, then the command."""
        change = command - previous
        short, still_short = max(abs(change) - rate * start, 0.0), max(abs(change) - rate * end, 0.0)
        if still_short > 0.0:  # on its way throughout: the only case in which the rate may be 0
            return previous + math.copysign(0.5 * rate * (start + end), change)
        return command - math.copysign(short**2 / (2.0 * rate * (end - start)) if short else 0.0, change)
