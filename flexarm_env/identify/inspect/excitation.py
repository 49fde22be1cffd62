"""What recordings can show of an arm: how exactly each constant, and the smallest size of each effect that it lacks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

SHOWN, NOT_SHOWN = "shown", "not shown"
DETECTABLE, TOO_SMALL, NOT_EXCITED = "detectable", "too small to see", "not excited"


@dataclass(frozen=True)
class ConstantExcitation:
    """How exactly recordings would give a constant.

    Attributes:
        path: in the arm file, as "beam.length".
        value: as given.
        half_width: of the 90 % interval that a fit of these recordings would give.
        prior: half width of the interval that the arm file's spread alone gives.
        unit: of all three.
        state: "shown" or "not shown".
    """

    path: str
    value: float
    half_width: float
    prior: float
    unit: str
    state: str

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return {
            "value": self.value,
            "half_width": self.half_width,
            "prior_half_width": self.prior,
            "unit": self.unit,
            "state": self.state,
        }


@dataclass(frozen=True)
class EffectExcitation:
    """The smallest size of an effect that recordings would show.

    Attributes:
        effect: its name.
        parameter: the one that measures its strength.
        limit: smallest value that would be accepted, or largest where a small one is strong; None where none would be.
        typical: usual value in recordings of this size.
        unit: of both.
        sizes: the limit in typical sizes, the larger the stronger; infinite where there is none.
        falls: whether a smaller value is a stronger effect, as of a stiffness.
        state: "detectable", "too small to see" or "not excited".
    """

    effect: str
    parameter: str
    limit: float | None
    typical: float
    unit: str
    sizes: float
    falls: bool
    state: str

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return {
            "parameter": self.parameter,
            "limit": self.limit,
            "limit_is": "largest" if self.falls else "smallest",
            "typical": self.typical,
            "unit": self.unit,
            "state": self.state,
        }


@dataclass(frozen=True)
class Excitation:
    """What recordings can show of an arm, if the arm is near the truth.

    Attributes:
        constants: those that a fit would move.
        effects: those that the arm lacks.
        common_scale: whether the scale that torques, inertias and stiffnesses have in common is "shown"; "" where the arm file
            fixes it.
    """

    constants: tuple[ConstantExcitation, ...]
    effects: tuple[EffectExcitation, ...]
    common_scale: str

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return {
            "constants": {one.path: one.as_json() for one in self.constants},
            "effects": {one.effect: one.as_json() for one in self.effects},
            "common_scale": self.common_scale,
        }
