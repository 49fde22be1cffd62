"""Options of the wrappers: each with its default, its meaning and its bounds, and how a table of them is read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any, TypeVar

from flexarm_env import units
from flexarm_env.controllers import CONTROLLERS
from flexarm_env.errors import InputError, did_you_mean

Section = TypeVar("Section")

#: Entries of a list: every lag that there is, once.
LONGEST_LIST = 2001


def option(
    default: Any,
    meaning: str,
    least: float = -math.inf,
    most: float = math.inf,
    allowed: Any = None,
    longest: int = LONGEST_LIST,
) -> Any:
    """Make a field of a section: its default, its meaning for a person, and its bounds, those of each entry of a list."""
    rules = {"meaning": meaning, "least": least, "most": most, "allowed": allowed, "longest": longest}
    return field(default=default, metadata=rules)


@dataclass(frozen=True)
class ArmsOptions:
    """The arms of training, drawn anew for each episode; the nominal arm alone where all are 0."""

    payload: bool = option(True, "whether a tip mass of 0 to 0.3 kg is drawn")
    constants: float = option(0.1, "share by which torque constant, inertia, mass and stiffness differ", 0.0, 0.9)
    friction: float = option(0.2, "share by which friction differs", 0.0, 0.9)
    tap_rate: float = option(0.2, "taps on the hub per second, up to 0.5 Nm for 20 ms", 0.0, 50.0)
    dropout_rate: float = option(0.5, "drop-outs of a sensor per second, 50 ms each", 0.0, 50.0)
    backlash: float = option(0.0, "largest gap of a backlash that is drawn, at the motor [rad]; 0: none", 0.0, 1.0)
    delays: tuple[float, ...] = option((), "unmodelled delays of the command [s], each of an equal share of the arms", 0.0, 0.1)


@dataclass(frozen=True)
class InterfaceOptions:
    """Features of the policy and effect of its action."""

    lags: tuple[int, ...] = option((0, 2, 4, 8, 16, 32), "how many samples of 5 ms ago the shown readings are", 0, 2000)
    command_lags: tuple[int, ...] = option((0, 2, 4, 8), "how many samples of 5 ms ago the shown commands were sent", 0, 2000)
    averages: tuple[float, ...] = option((), "also readings averaged with these fading memories [s]", 0.005, 10.0)
    estimate: bool = option(True, "also show a Kalman filter's angle, bending, speeds and friction, and the payload estimate")
    base: str = option("none", "classical controller to whose command the action is added", allowed=("none", *CONTROLLERS))
    authority: float = option(1.0, "command at action 1, as a share of the drive's limit", 0.001, 2.0)
    repeat: int = option(2, "samples of 5 ms for which an action is held", 1, 100)
    pulse: float = option(
        0.0, "as authority, of a second action that is sent in the first of these samples only; 0: none", 0.0, 2.0
    )
    privileged: bool = option(True, "PPO's critic alone also sees the true state and the drawn constants, in training only")

    @property
    def actions(self) -> int:
        """Count the numbers of an action."""
        return 2 if self.pulse else 1


@dataclass(frozen=True)
class RewardOptions:
    """Reward of training; evaluation has measures of its own.

    Each sample costs the tip's error and the vibration, both on a scale where halving them is worth the same whether they
    are large or small: log(1 + size / scale), over that of 100° or 3 V. The vibration's size is that of the strain now and an
    eighth of a second before, in quadrature: its amplitude at 2 Hz, and no more than that for the faster vibrations.
    """

    tip_scale: float = option(0.2, "error of the tip [deg] below which less is hardly worth anything", 1e-4, 100.0)
    strain_scale: float = option(0.01, "vibration at the base gage [V] below which less is hardly worth anything", 1e-5, 10.0)
    vibration: float = option(0.5, "weight of the vibration; the tip's error has 1", 0.0, 100.0)
    rise: float = option(1.0, "factor by which that weight has grown at the end; linear between", 0.0, 100.0)
    near: float = option(0.0, "vibration costs only near the target: error [deg] at which it counts 1/e; 0: everywhere", 0.0, 1e3)
    distance: float = option(0.0, "weight of the tip's error in rad, on a linear scale", 0.0, 100.0)
    effort: float = option(0.02, "weight of (command / limit)²", 0.0, 100.0)
    change: float = option(0.0, "weight of (change of the command / limit)²", 0.0, 100.0)


def read_options(section: type[Section], table: Any, prefix: str = "") -> Section:
    """Convert a table of TOML or JSON to the options of a section.

    Args:
        section: class of the options; a section of it is a table in the table.
        table: values by name; those that are left out are the defaults.
        prefix: path of the table, for messages.

    Raises:
        InputError: for a name that does not exist, or a value that is none.
    """
    if not isinstance(table, Mapping):
        name = prefix.rstrip(".")
        remedy = f"write [{name}]" if name else f"give some of {', '.join(each.name for each in fields(section))} by name"  # type: ignore[arg-type]
        raise InputError(f"{name or 'the options'} = {table!r} is not a table; {remedy}")
    known = {entry.name: entry for entry in fields(section)}  # type: ignore[arg-type]
    found = {}
    for key, value in table.items():
        if key not in known:
            raise InputError(f"unknown key '{prefix}{key}'{did_you_mean(key, known)}")
        default = getattr(section(), key)
        if is_dataclass(default):
            found[key] = read_options(type(default), value, f"{prefix}{key}.")
        else:
            found[key] = _value(f"{prefix}{key}", value, default, known[key].metadata)
    return section(**found)


def _value(path: str, value: Any, default: Any, rules: Mapping[str, Any]) -> Any:
    """Convert a value to the type of its default."""
    if isinstance(default, tuple):
        if not isinstance(value, list | tuple):
            raise InputError(f"{path} = {value!r}; give a list such as {list(default)}")
        if len(value) > rules["longest"]:
            raise InputError(f"{path} has {len(value)} entries; give {rules['longest']} at most")
        return tuple(_number(path, entry, default[0] if default else 0.0, rules) for entry in value)
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise InputError(f"{path} = {value!r}; give true or false")
        return value
    if isinstance(default, str):
        if not isinstance(value, str):
            raise InputError(f"{path} = {value!r}; give a text such as '{default}'")
        if rules["allowed"] is not None and value not in rules["allowed"]:
            raise InputError(f"{path} = '{value}'{did_you_mean(value, rules['allowed'])}")
        return value
    return _number(path, value, default, rules)


def _number(path: str, value: Any, default: float, rules: Mapping[str, Any]) -> float:
    kinds = int if isinstance(default, int) else int | float
    if isinstance(value, bool) or not isinstance(value, kinds):
        raise InputError(f"{path} = {value!r}; give a {'whole ' if kinds is int else ''}number")
    if not rules["least"] <= value <= rules["most"]:
        raise InputError(f"{path} = {units.as_float(value):g}; allowed are {rules['least']:g} to {rules['most']:g}")
    return type(default)(value)
