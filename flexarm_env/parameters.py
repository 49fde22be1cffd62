"""Parameters: units, bounds and priors of physical quantities, and how a value of one is read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flexarm_env.errors import InputError
from flexarm_env.units import as_float, quantity

#: SI unit of each kind of command.
INPUTS: dict[str, str] = {"current": "A", "voltage": "V", "torque": "N*m", "position": "rad"}
#: Parts that an effect or a sensor may need of an arm, beside its input, in words.
NEEDS = {
    "beam": "a beam",
    "tip": "a tip of a beam or of a link with a length",
    "soft_gears": "a joint or gears with a stiffness",
    "windup": "a motor's speed or a servo",
    "motor": "a motor with constants of its own",
    "amplifier": "a drive other than a servo",
    "motor_inertia": "an inertia of the motor",
    "hub_inertia": "an inertia of the hub",
    "supply": "a supply voltage without a sensor of the current",
}


@dataclass(frozen=True)
class Parameter:
    """A physical quantity of an arm file, with its bounds and its prior in a fit.

    Attributes:
        unit: SI unit, as pint writes it; "" for a ratio.
        low: lower bound.
        high: upper bound.
        typical: usual size in the thesis's arm, where a search starts.
        null: value at which the effect is absent; None where no single value means absence.
        onset: value below which one that is absent at infinity begins to act, in a recording of the typical size.
        spread: relative standard deviation of the prior around the value of the arm file. 0 keeps the value; infinity, the
            default of an effect's parameter, is no prior.
        meaning: description in one line.
        source: equation, table or paper.
        of_command: whether the quantity is a command, in A or V.
        of_travel: whether it is a place within the arm's travel, whose typical value is from the middle of the thesis's arm's.
        is_count: whether it is a whole number.

    Example:
        >>> gap = Parameter("rad", 0.0, 1.0, 0.06, null=0.0, meaning="gap of the gears, motor side")
        >>> gap.scaled_by({"rad": 2.0})
        2.0
    """

    unit: str
    low: float
    high: float
    typical: float
    null: float | None = None
    onset: float = float("inf")
    spread: float = float("inf")
    meaning: str = ""
    source: str = ""
    of_command: bool = False
    of_travel: bool = False
    is_count: bool = False

    def scaled_by(self, scales: Mapping[str, float]) -> float:
        """Look up the factor on the typical size.

        Args:
            scales: factors by unit, "command" for commands and "travel" for places; 1 where the unit is missing.
        """
        return scales.get("command" if self.of_command else "travel" if self.of_travel else self.unit, 1.0)

    def times(self, value: float, factor: float, scales: Mapping[str, float]) -> float:
        """Make a size so many times larger, within the bounds.

        A limit is the larger the more of what it limits lies beyond it: the difference of its reciprocal from that of its onset.

        Args:
            value: of the parameter, whose null is 0 or infinity.
            factor: at least 0 where the null is infinity.
            scales: as of `scaled_by`.

        Example:
            >>> limit = Parameter("A", 0.0, math.inf, 3.0, null=math.inf, onset=5.0)
            >>> [round(limit.times(4.0, factor, {}), 3) for factor in (0.0, 0.5, 2.0)]
            [5.0, 4.444, 3.333]
        """
        if self.null != math.inf:
            return min(max(value * factor, self.low), self.high)
        onset = self.onset * self.scaled_by(scales)
        least = 1.0 / onset if value < onset else 0.0
        reciprocal = least + factor * (1.0 / value - least)
        return min(max(1.0 / reciprocal if reciprocal > 0.0 else math.inf, self.low), self.high)

    def under(self, command: str) -> Parameter:
        """Fill in the unit of a command, which the catalogue leaves open.

        Args:
            command: kind of the drive's command.

        Example:
            >>> [Parameter(unit, 0.0, 1.0, 0.1, of_command=True).under("current").unit for unit in ("", "1/s")]
            ['A', 'A/s']
        """
        if not self.of_command:
            return self
        unit = INPUTS[command]
        filled = unit + self.unit.removeprefix("1") if self.unit.startswith("1/") else self.unit or unit
        return replace(self, unit=filled)


def reading_noise(sensor: Mapping[str, float]) -> float:
    """Compute the standard deviation of a sensor's reading in its own unit: its noise, and the rounding to its steps."""
    return float(np.hypot(sensor["noise"], sensor["resolution"] / 12**0.5))


def read_value(path: str, value: Any, parameter: Parameter, command: str) -> float:
    """Read a value that a person gives: a number in SI, or a text with a unit.

    Args:
        path: of the value, for messages.
        value: as given.
        parameter: with unit and bounds.
        command: kind of the drive's command, the unit of which its quantities have, or the one that the catalogue leaves open.

    Raises:
        InputError: for what is no number, a unit that does not convert, and a value out of bounds.

    Example:
        >>> read_value("effects.backlash.gap", "60 mrad", Parameter("rad", 0.0, 1.0, 0.06), "current")
        0.06
    """
    if not isinstance(value, str) or not parameter.unit or not value.endswith(f" {parameter.unit}"):
        parameter = parameter.under(command)
    try:
        if isinstance(value, bool):
            raise TypeError
        number = quantity(value, parameter.unit) if isinstance(value, str) else as_float(value)
    except (TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise InputError(f"{path}: {error}") from None
        written = f' or "{parameter.typical:g} {parameter.unit}"' if parameter.unit else ""
        raise InputError(f"{path} = {value!r} is no number; write for example {parameter.typical:g}{written}") from None
    if math.isnan(number):
        raise InputError(f"{path} is not a number")
    return check_bounds(path, number, parameter)


def check_bounds(path: str, value: float, parameter: Parameter) -> float:
    """Check a value against its parameter's bounds, and return it.

    Raises:
        InputError: for a value out of bounds, and a count that is no whole number.
    """
    if not parameter.low <= value <= parameter.high:
        unit = f" {parameter.unit}" if parameter.unit else ""
        raise InputError(f"{path} = {value:g}{unit} is out of bounds: allowed are {parameter.low:g} to {parameter.high:g}{unit}")
    if parameter.is_count and value != int(value):
        raise InputError(f"{path} = {value:g}; write a whole number")
    return value
