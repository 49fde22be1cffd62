"""Range and scale of a parameter's slider."""

from __future__ import annotations

import math
from dataclasses import dataclass

from flexarm_env.parameters import Parameter

#: Ends of a slider, over the usual size.
LARGEST, SMALLEST, ROOM = 5.0, 0.05, 2.0
STEPS = 200
#: Where the bounds of a parameter are closer than this, as of a phase, they are the slider's ends.
NARROW = 15.0


@dataclass(frozen=True)
class Scale:
    """A slider's ends, in the parameter's unit; on a logarithmic one positions are decades.

    Attributes:
        low: value at the left end.
        high: value at the right end.
        logarithmic: whether equal distances are equal ratios.
    """

    low: float
    high: float
    logarithmic: bool

    def position(self, value: float) -> float:
        """Convert a value to a position, 0 to `STEPS`."""
        low, high, at = (math.log(x) for x in (self.low, self.high, value)) if self.logarithmic else (self.low, self.high, value)
        return STEPS * (at - low) / (high - low)

    def value(self, position: float) -> float:
        """Convert a position to a value, to four digits, the ends exactly."""
        share = min(max(position / STEPS, 0.0), 1.0)
        if share in (0.0, 1.0):
            return self.high if share else self.low
        if self.logarithmic:
            return float(f"{self.low * (self.high / self.low) ** share:.4g}")
        return float(f"{self.low + share * (self.high - self.low):.4g}")


def scale_of(parameter: Parameter, value: float, size: float) -> Scale:
    """Choose the scale of a parameter's slider.

    Args:
        parameter: with its bounds.
        value: the initial one; the slider extends beyond it.
        size: a typical size of the parameter in these recordings.
    """
    if parameter.high - parameter.low <= NARROW and parameter.null is None:
        return Scale(parameter.low, parameter.high, False)
    usual = max(abs(size), 1e-12)
    at = abs(value) if math.isfinite(value) else 0.0
    high = min(max(LARGEST * usual, ROOM * at), parameter.high)
    if parameter.null == 0.0 or parameter.low < 0.0:
        return Scale(max(-high if parameter.low < 0.0 else 0.0, parameter.low), high, False)
    low = max(min(SMALLEST * usual, at / ROOM if at else math.inf), parameter.low, 1e-12)
    return Scale(low, max(high, 2.0 * low), True)
