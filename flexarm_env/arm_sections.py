"""Sections of an arm file: their keys with units, bounds and priors, and the defaults of those that may be omitted."""

from __future__ import annotations

import math
from collections.abc import Collection

from flexarm_env.parameters import Parameter

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
