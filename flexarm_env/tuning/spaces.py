"""Ranges over which a search varies the options of each control law."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from flexarm_env.errors import InputError, did_you_mean


class Range(NamedTuple):
    """Lowest and highest value of an option, and whether its logarithm is searched evenly."""

    low: float
    high: float
    logarithmic: bool = True


#: Gains of PD, for the thesis's drive [A/rad, A s/rad].
_PD = {"proportional": Range(0.5, 40.0), "derivative": Range(0.05, 5.0)}
#: Gains on the beam's torque, and the speed between them [rad/s].
_BY_SPEED = _PD | {
    "high_gain": Range(-2.0, 0.5, False),
    "low_gain": Range(-0.5, 2.0, False),
    "low_speed": Range(0.01, 1.0),
}
_REGULATOR = {
    "design.angle": Range(0.02, 0.6),
    "design.deflection": Range(0.03, 1.0),
    "design.speed": Range(0.2, 6.0),
    "design.tip_speed": Range(0.2, 6.0),
    "design.command": Range(0.05, 1.0),
    "design.integration": Range(0.1, 10.0),
    "design.friction_change": Range(0.003, 0.1),
    "design.dead_time": Range(0.0, 0.0125, False),
}
_LQG = _REGULATOR | {"design.share": Range(0.3, 1.5)}
#: Options of each law that a search varies, by name; "design.angle" is the angle of a design.
SPACES: Mapping[str, Mapping[str, Range]] = {
    "pd": _PD,
    "pd_rate_limited": _PD | {"rate": Range(5.0, 500.0)},
    "vibration_dual": _BY_SPEED,
    "vibration_filtered": _BY_SPEED,
    "shaped_zv": _PD,
    "shaped_zvd": _PD,
    "lqg": _LQG,
    "lqg_scheduled": _LQG,
    "pid_compensated": {
        "design.speed": Range(1.5, 6.0),
        "design.acceleration": Range(5.0, 60.0),
        "design.bandwidth": Range(1.0, 8.0),
        "design.damping": Range(0.3, 2.0),
        "design.integral": Range(0.05, 0.5),
        "design.friction": Range(0.5, 1.3, False),
        "design.slide": Range(2.0, 50.0),
        "design.width": Range(0.03, 1.0),
    },
    "mpc": _REGULATOR | {"design.horizon": Range(0.15, 1.0)},
}


def space_of(controller: str) -> Mapping[str, Range]:
    """Look up the ranges of a law.

    Raises:
        InputError: for a name without ranges.
    """
    if controller not in SPACES:
        raise InputError(f"no controller '{controller}' to tune{did_you_mean(controller, SPACES)}")
    return SPACES[controller]


def nested(values: Mapping[str, float]) -> dict[str, Any]:
    """Turn values by path into options.

    Examples:
        >>> nested({"proportional": 2.0, "design.angle": 0.1, "design.speed": 1.0})
        {'proportional': 2.0, 'design': {'angle': 0.1, 'speed': 1.0}}
    """
    options: dict[str, Any] = {}
    for path, value in values.items():
        table, _, name = path.rpartition(".")
        (options.setdefault(table, {}) if table else options)[name] = value
    return options
