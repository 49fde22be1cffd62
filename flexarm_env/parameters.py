"""Parameters with units, bounds and priors, and the base constants of an arm."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
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


TABLE = "thesis Table A.1"
#: Tilt of an axis that is level, about which gravity acts in full.
LEVEL = math.pi / 2

DRIVE = {
    "torque_constant": Parameter(
        "Nm/A",
        1e-6,
        1e4,
        0.33,
        spread=0.15,
        meaning="motor torque per current, and back-EMF per speed",
        source="thesis App. A",
    ),
    "gear_ratio": Parameter("", 1e-3, 1e4, 1.5, spread=0.0, meaning="motor turns per arm turn", source=TABLE),
    "efficiency": Parameter(
        "", 0.01, 1.0, 1.0, spread=0.0, meaning="of motor and gears: torque on the arm over that without losses"
    ),
    "amplifier_gain": Parameter(
        "", 0.0, 1e3, 1.0, spread=0.1, meaning="command that the amplifier gives out over the recorded one; 0: exact"
    ),
    "motor_inertia": Parameter(
        "kg*m**2", 0.0, 1e4, 0.00193, spread=0.3, meaning="rotor and motor gear, motor side", source=TABLE
    ),
    "resistance": Parameter(
        "ohm",
        0.0,
        1e6,
        1.35,
        spread=0.0,
        meaning="armature resistance (voltage and position drive)",
        source="thesis App. A, experiment 1",
    ),
    "proportional": Parameter(
        "", 0.0, 1e6, 400.0, spread=0.0, meaning="gain of the servo's firmware on the position error (position drive only)"
    ),
    "derivative": Parameter(
        "s", 0.0, 1e6, 0.0, spread=0.0, meaning="gain of the servo's firmware on the speed (position drive only)"
    ),
    "error_gain": Parameter(
        "1/rad", 0.0, 1e6, 0.01, spread=0.15, meaning="duty by 1 rad and a firmware gain of 1 (position drive only)"
    ),
    "supply_voltage": Parameter("V", 0.0, 1e6, 0.0, spread=0.0, meaning="voltage at a duty of 1 (position and voltage drive)"),
    "largest_duty": Parameter("", 1e-3, 1.0, 1.0, spread=0.0, meaning="share of the supply that the servo gives out at most"),
    "current_limit": Parameter("A", 0.0, 1e6, 0.0, spread=0.0, meaning="of the servo's firmware; 0: none"),
    "enabled": Parameter("", 0.0, 1.0, 1.0, spread=0.0, meaning="1: the drive is on; 0: the motor's circuit is open"),
    "limit": Parameter(
        "",
        0.0,
        1e6,
        5.0,
        spread=0.0,
        meaning="largest command, in A, V, Nm or rad",
        source="thesis section 4.2",
        of_command=True,
    ),
    "torque_noise": Parameter(
        "N*m", 0.0, 1e4, 0.0, spread=0.0, meaning="unmodelled disturbance torque at the hub, standard deviation per sample"
    ),
    "gear_stiffness": Parameter(
        "N*m/rad",
        0.0,
        1e9,
        4000.0,
        spread=0.1,
        meaning="of the touching gears, arm side; 0: motor and hub are one body",
    ),
    "motor_coulomb_share": Parameter(
        "", 0.0, 1.0, 0.351, spread=0.3, meaning="part of Coulomb friction on the motor side of the gears", source=TABLE
    ),
    "motor_stiction_share": Parameter(
        "",
        0.0,
        1.0,
        0.5696,
        spread=0.3,
        meaning="part of what static friction adds on the motor side of the gears",
        source=TABLE,
    ),
    "motor_viscous_share": Parameter(
        "",
        0.0,
        1.0,
        0.0177,
        spread=0.0,
        meaning="part of viscous friction on the motor side of the gears",
        source=TABLE,
    ),
}
HUB = {
    "inertia": Parameter(
        "kg*m**2", 0.0, 1e4, 0.00129, spread=0.3, meaning="all that turns with the hub, without the beam", source=TABLE
    ),
}
BEAM = {
    "elements": Parameter("", 1, 16, 1, spread=0.0, meaning="finite elements", source="thesis section 3.1", is_count=True),
    "length": Parameter("m", 1e-3, 1e2, 1.0, spread=0.0, meaning="from the hub's axis to the tip", source="thesis section 3.3"),
    "mass_per_length": Parameter("kg/m", 1e-6, 1e4, 0.42381, spread=0.15, source="thesis section 3.4"),
    "bending_stiffness": Parameter("N*m**2", 1e-6, 1e8, 7.911324, spread=0.15, meaning="E times I", source="thesis section 3.4"),
    "tip_mass": Parameter("kg", 0.0, 1e3, 0.0, spread=0.0, meaning="known mass at the tip"),
    "tip_inertia": Parameter("kg*m**2", 0.0, 1e3, 0.0, spread=0.0, meaning="known inertia of the tip mass about the tip"),
}
GRAVITY = {
    "tilt": Parameter("rad", 0.0, LEVEL, 0.0, spread=0.0, meaning="of the axis from the vertical; 90°: it is level"),
    "hangs_at": Parameter("rad", -6.3, 6.3, 0.0, spread=0.0, meaning="angle of the arm at which it hangs"),
}
BEAM |= GRAVITY
LINK = {
    "mass": Parameter("kg", 1e-6, 1e4, 0.1, spread=0.15, meaning="of the rigid link, which gives its weight"),
    "centre": Parameter("m", 1e-6, 1e2, 0.1, spread=0.0, meaning="from the axis to the centre of mass"),
    "inertia": Parameter("kg*m**2", 0.0, 1e4, 1e-3, spread=0.3, meaning="of the rigid link about the axis"),
    "length": Parameter("m", 0.0, 1e2, 0.0, spread=0.0, meaning="from the axis to the tip, which carries a payload; 0: no tip"),
} | GRAVITY
JOINT = {
    "stiffness": Parameter("N*m/rad", 1e-6, 1e9, 100.0, spread=0.15, meaning="of the spring between hub and link"),
    "damping": Parameter("N*m*s/rad", 0.0, 1e6, 0.01, spread=0.5, meaning="of that spring"),
}
SECTIONS: dict[str, dict[str, Parameter]] = {"drive": DRIVE, "hub": HUB, "beam": BEAM, "link": LINK, "joint": JOINT}

#: Defaults of keys that an arm file may omit.
DEFAULTS: dict[str, dict[str, float]] = {
    "drive": {
        "efficiency": 1.0,
        "amplifier_gain": 0.0,
        "resistance": 0.0,
        "proportional": 0.0,
        "derivative": 0.0,
        "error_gain": 0.0,
        "supply_voltage": 0.0,
        "largest_duty": 1.0,
        "current_limit": 0.0,
        "enabled": 1.0,
        "limit": 0.0,
        "torque_noise": 0.0,
        "gear_stiffness": 0.0,
        "motor_coulomb_share": 0.351,
        "motor_stiction_share": 0.5696,
        "motor_viscous_share": 0.0177,
    },
    "hub": {},
    "beam": {"tip_mass": 0.0, "tip_inertia": 0.0, "tilt": 0.0, "hangs_at": 0.0},
    "link": {"length": 0.0, "tilt": 0.0, "hangs_at": 0.0},
    "joint": {"damping": 0.0},
}
#: Defaults of a drive without motor constants, and of the friction's shares in front of an elastic joint.
TORQUE_DRIVE = {"torque_constant": 1.0, "gear_ratio": 1.0, "motor_inertia": 0.0}
BEFORE_JOINT = {"motor_coulomb_share": 1.0, "motor_stiction_share": 1.0, "motor_viscous_share": 1.0}


def defaults_of(section: str, command: str, parts: Collection[str]) -> dict[str, float]:
    """Collect the defaults of a section's keys, which depend on the kind of drive and on the parts of the arm.

    Args:
        section: of an arm file, "drive", "hub", ….
        command: kind of the drive's command.
        parts: names of the arm file's sections.
    """
    values = dict(DEFAULTS[section])
    if section == "drive" and command == "torque":
        values |= TORQUE_DRIVE
    if section == "drive" and "joint" in parts:
        values |= BEFORE_JOINT
    if section == "hub" and "link" in parts:
        values["inertia"] = 0.0
    return values


#: Keys of a sensor's table. Units, defaults and priors of each signal: `Sensor.settings`.
SENSOR = {
    "gain": Parameter("", -1e6, 1e6, 1.0, spread=0.0, meaning="reading per quantity"),
    "offset": Parameter("", -1e6, 1e6, 0.0, spread=0.0, meaning="reading at zero"),
    "noise": Parameter("", 0.0, 1e6, 0.0, spread=0.0, meaning="standard deviation of the reading"),
    "resolution": Parameter("", 0.0, 1e6, 0.0, spread=0.0, meaning="step of the reading"),
    "filter": Parameter("s", 0.0, 10.0, 0.0, spread=0.0, meaning="time constant of a first-order filter"),
    "delay": Parameter("s", 0.0, 1.0, 0.0, spread=0.0, meaning="dead time of the reading"),
    "position": Parameter("m", 0.0, 1e2, 0.0, spread=0.0, meaning="of a strain gage along the beam"),
    "per_volt": Parameter("", -1e6, 1e6, 0.0, spread=0.0, meaning="quantity per volt of a recording in volts; 0: not stated"),
}


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
