"""A machine in the settings of the rig: its constants and its friction."""

from __future__ import annotations

import math
from collections.abc import Mapping

from benchmarks.machines.model import clamped_frequency

Values = Mapping[str, float]
Settings = dict[str, float]

GRAVITY = 9.81
#: Damping of the gears over their stiffness [s]; frequency of the motor on gears that have play only [rad/s].
GEAR_DAMPING, STIFF_GEARS = 5e-4, 960.0
#: Steps of the integrator [s], each a part of those after it and of every sample; largest phase that the fastest part of a
#: machine may turn in one.
STEPS, PHASE = (1e-5, 2e-5, 4e-5), 0.15
#: Fastest vibration of a beam of n finite elements over its lowest, over n²: 15.5 to 16.9 for 2 to 4 elements on any hub.
HIGHEST = 17.0


def settings(values: Values, volts: bool) -> Settings:
    """Convert the values of a machine, by their paths in an arm file, to the rig's settings.

    Args:
        values: in SI units.
        volts: whether its commands are voltages.
    """
    drive = {key: values[f"drive.{key}"] for key in ("gear_ratio", "torque_constant", "motor_inertia", "resistance")}
    found = {"gear": drive["gear_ratio"], "kphi": drive["torque_constant"], "jm": drive["motor_inertia"]}
    found |= {"jh": values["hub.inertia"], "volts": float(volts), "elements": 0.0, "joined": 1.0, "split": 1.0}
    found |= {"ra": drive["resistance"]} if volts else {}
    if "beam.length" in values:
        found |= _beam(values)
    found |= friction(values)
    stiffness = values.get("drive.gear_stiffness", 0.0)
    if stiffness > 0.0:
        found = two_bodies(found, values) | gears(stiffness)
    return found | _weight(values)


def _beam(values: Values) -> Settings:
    keys = {"length": "length", "density": "mass_per_length", "ei": "bending_stiffness", "elements": "elements"}
    found = {setting: values[f"beam.{key}"] for setting, key in keys.items()} | {"modes": 2.0 * values["beam.elements"]}
    found["beam_damp"] = values.get("effects.beam_damping.time", 0.0)
    gains = {place: values.get(f"sensors.strain_{place}.gain", 1.0) for place in ("mid", "base")}
    found |= {f"x_{place}": values.get(f"sensors.strain_{place}.position", 0.0) for place in gains}
    return found | {"ksg": gains["mid"], "ksgb": gains["base"] / gains["mid"]}


def friction(values: Values) -> Settings:
    """Convert friction on one body; that of the motor is none."""
    coulomb = values.get("effects.coulomb.torque", 0.0)
    extra = values.get("effects.stiction.extra", 0.0)
    viscous = values.get("effects.viscous.coefficient", 0.0)
    return {"bs": viscous, "taf": coulomb, "tas": coulomb + extra, "bm": 0.0, "tmf": 0.0, "tms": 0.0}


def two_bodies(found: Settings, values: Values) -> Settings:
    """Separate motor and hub, and give the motor its shares of the friction."""
    shares = {key: values[f"drive.motor_{key}_share"] for key in ("coulomb", "stiction", "viscous")}
    coulomb, extra, viscous = found["taf"], found["tas"] - found["taf"], found["bs"]
    sliding, rest = shares["coulomb"] * coulomb, shares["stiction"] * extra
    ratio = found["gear"]
    split = {"bm": shares["viscous"] * viscous / ratio**2, "bs": (1.0 - shares["viscous"]) * viscous}
    split |= {"tmf": sliding / ratio, "tms": (sliding + rest) / ratio}
    split |= {"taf": coulomb - sliding, "tas": coulomb - sliding + extra - rest}
    return found | split | {"joined": 0.0}


def gears(stiffness: float) -> Settings:
    """Set the touching gears: stiffness [Nm/rad], arm side, and their damping."""
    return {"mesh": stiffness, "mesh_c": GEAR_DAMPING * stiffness}


def stiff_gears(values: Values) -> Settings:
    """Set gears that are as good as rigid."""
    return gears(STIFF_GEARS**2 * values["drive.gear_ratio"] ** 2 * values["drive.motor_inertia"])


def _weight(values: Values) -> Settings:
    torque = values.get("effects.base_tilt.torque", 0.0)
    return tilted(values, torque, values["effects.base_tilt.uphill"] + math.pi) if torque else {}


def tilted(values: Values, torque: float, downhill: float) -> Settings:
    """Set gravity by its largest torque about the hub [Nm] and the hub angle at which the arm hangs lowest [rad]."""
    if "beam.length" not in values:
        return {"weight": torque, "tilt_dir": downhill}
    return {"tilt": math.asin(torque / most_weight(values)), "tilt_dir": downhill}


def most_weight(values: Values) -> float:
    """Compute the torque of gravity about the hub of a beam on a vertical slope [Nm]."""
    return GRAVITY * values["beam.mass_per_length"] * values["beam.length"] ** 2 / 2.0


def step(values: Values, found: Settings) -> float:
    """Choose the integrator's step [s] for a machine: the smallest for two bodies, else for the fastest vibration of its beam."""
    if not found["joined"]:
        return STEPS[0]
    keys = ("length", "mass_per_length", "bending_stiffness")
    lowest = clamped_frequency(**{key: values[f"beam.{key}"] for key in keys}) if "beam.length" in values else 0.0
    fastest = HIGHEST * lowest * values.get("beam.elements", 0.0) ** 2
    return max([step for step in STEPS if step * fastest <= PHASE], default=STEPS[0])
