"""A fitted value with its interval."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Estimate:
    """A fitted value with its 90 % interval, in SI units.

    Attributes:
        path: in the arm file, as "beam.length".
        value: the fitted value.
        low: lower end of the 90 % interval.
        high: upper end.
        unit: of all three.
        nominal: the value before the fit.
    """

    path: str
    value: float
    low: float
    high: float
    unit: str
    nominal: float

    def as_json(self) -> dict[str, Any]:
        """Convert value, interval and unit to plain data."""
        return {"value": self.value, "unit": self.unit, "low": self.low, "high": self.high}
