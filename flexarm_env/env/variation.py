"""Differences from episode to episode: constants and effects of the arm, taps on its hub, drop-outs of its sensors."""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from flexarm_env.arm import Arm
from flexarm_env.effects import Effect
from flexarm_env.env.given import one_number, two_numbers
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import check_bounds

Range = Sequence[float]
#: Lowest value of a range that begins at an effect's absence, as a share of the range: there its law is still active.
LEAST_SHARE = 1e-9
LARGEST_SETTING = 1e6
#: Constants that are the same for all arms of an environment: actions are shares of the limit, and only identification
#: uses the noise.
NEVER_DRAWN = ("drive.limit", "drive.torque_noise")
#: Settings of a sensor that are part of the plant; noise, steps and delay are the same for all arms of an environment.
IN_THE_PLANT = ("gain", "offset", "filter", "position")
EXAMPLES = {"randomise": '{"payload.mass": (0.0, 0.3)}', "vary": '{"hub.inertia": 0.1}', "disturb": '{"tap_rate": 1.0}'}


@dataclass(frozen=True)
class Disturbance:
    """Taps on the hub and sensors that drop out, at random times.

    Attributes:
        tap_rate: taps per second.
        tap_torque: largest torque of a tap, on the hub [Nm]; each is uniform between plus and minus this.
        tap_time: duration of a tap [s].
        dropout_rate: drop-outs per second.
        dropout_time: duration of a drop-out, in which one sensor repeats its last reading [s].

    Raises:
        InputError: for a setting out of bounds.

    Examples:
        >>> Disturbance(tap_rate=1.0, dropout_rate=2.0).tap_torque
        0.5
    """

    tap_rate: float = 0.0
    tap_torque: float = 0.5
    tap_time: float = 0.02
    dropout_rate: float = 0.0
    dropout_time: float = 0.05

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            remedy = f"give a number from 0 to {LARGEST_SETTING:g}"
            if not 0.0 <= one_number(f"disturb: {name}", value, remedy) <= LARGEST_SETTING:
                raise InputError(f"disturb: {name} = {value!r}; {remedy}")


def find_disturbance(given: Disturbance | Mapping[str, float] | None) -> Disturbance:
    """Make a disturbance from its settings, or pass one on.

    Raises:
        InputError: for a setting that does not exist or a value that is none.
    """
    if isinstance(given, Disturbance):
        return given
    if not isinstance(given, Mapping | None):
        raise InputError(f"disturb = {given!r}; give a table such as {EXAMPLES['disturb']}")
    for name in given or {}:
        if name not in Disturbance.__dataclass_fields__:
            raise InputError(f"disturb: unknown setting '{name}'{did_you_mean(str(name), Disturbance.__dataclass_fields__)}")
    return Disturbance(**(given or {}))


@dataclass(frozen=True)
class Variation:
    """Values that are drawn anew, uniformly, for each episode: path in the arm, lowest and highest value (SI units)."""

    ranges: tuple[tuple[str, float, float], ...] = ()

    def arm(self, arm: Arm, draws: Sequence[float]) -> Arm:
        """Set each value in the arm by its draw, from 0 up to 1 (ranges,)."""
        values = {path: low + draw * (high - low) for (path, low, high), draw in zip(self.ranges, draws, strict=True)}
        return arm.with_values(values)


def find_variation(arm: Arm, randomise: Mapping[str, Range] | None, vary: Mapping[str, float] | None) -> tuple[Arm, Variation]:
    """Resolve the ranges of drawn values; return the arm with all drawn effects, and the ranges.

    Args:
        arm: the nominal one.
        randomise: (lowest, highest) value in SI units of paths such as "payload.mass" or "hub.inertia".
        vary: share by which the arm's own value may differ, as {"hub.inertia": 0.1} for ±10 %.

    Raises:
        InputError: for a path that does not exist, a range that is none or out of bounds, or a share of an effect that the arm
            lacks.
    """
    nominal, ranges = arm, []
    for name, table in (("randomise", randomise), ("vary", vary)):
        if not isinstance(table, Mapping | None):
            raise InputError(f"{name} = {table!r}; give a table such as {EXAMPLES[name]}")
    for path in (*(randomise or {}), *(vary or {})):
        if not isinstance(path, str):
            raise InputError(f"randomise or vary: {path!r} is no path; write one such as 'hub.inertia'")
    for path, given in (randomise or {}).items():
        low, high = _pair(path, given)
        arm, place = _place(arm, path)
        ranges.append((place, *_bounded(arm, place, low, high)))
    for path, share in (vary or {}).items():
        remedy = "give a share from 0 to less than 1, as 0.1 for ±10 %"
        if not 0.0 <= one_number(f"vary: {path}", share, remedy) < 1.0:
            raise InputError(f"vary: {path} = {share}; {remedy}")
        with_effect, place = _place(nominal, path)
        if with_effect is not nominal:
            effect = place.split(".")[1]
            raise InputError(
                f"vary: {path} is a share of the arm's own value, and arm '{nominal.name}' has no {effect}; give lowest and "
                f"highest in randomise, or add the effect to the arm first"
            )
        ends = sorted(nominal.value(place) * (1.0 + sign * float(share)) for sign in (-1, 1))
        ranges.append((place, *_bounded(arm, place, *ends)))
    _check_together(arm, ranges)
    return arm, Variation(tuple(ranges))


def _check_together(arm: Arm, ranges: Sequence[tuple[str, float, float]]) -> None:
    """Refuse a value that is drawn twice, and a gage that can lie beyond the beam's end."""
    places = [place for place, _, _ in ranges]
    for place in places:
        if places.count(place) > 1:
            raise InputError(f"'{place}' is drawn twice; name it once, in randomise or in vary")
    ends = {place: (low, high) for place, low, high in ranges}
    length = arm.constants.get("beam", {}).get("length", math.inf)
    shortest = ends.get("beam.length", (length, length))[0]
    for signal, sensor in arm.sensors.items():
        place = f"sensors.{signal}.position"
        furthest = ends.get(place, (0.0, sensor["position"]))[1]
        if furthest > shortest:
            raise InputError(f"{place} may be {furthest:g} m, beyond the beam's end at {shortest:g} m; narrow the ranges")


def _pair(path: str, given: Range) -> tuple[float, float]:
    low, high = two_numbers(f"randomise: {path}", given, "give two numbers, lowest and highest")
    if not low <= high:
        raise InputError(f"randomise: {path} = ({low:g}, {high:g}); give the lowest value first")
    return low, high


def _place(arm: Arm, path: str) -> tuple[Arm, str]:
    """Resolve the path of a value; return the arm, with the value's effect, and the full path."""
    if path in NEVER_DRAWN:
        raise InputError(f"'{path}' is the same for all arms of an environment; change it in the arm file")
    section, _, key = path.removeprefix("effects.").partition(".")
    if section in arm.known and key in arm.known[section].parameters:
        return (arm if section in arm.effects else arm.with_effect(section)), f"effects.{section}.{key}"
    if section == "sensors":
        signal, _, key = key.partition(".")
        if key in arm.sensors.get(signal, {}) and key in IN_THE_PLANT:
            return arm, path
    elif key in arm.constants.get(section, {}):
        return arm, path
    every = [f"{s}.{k}" for s, table in arm.constants.items() for k in table if f"{s}.{k}" not in NEVER_DRAWN]
    every += [f"sensors.{signal}.{key}" for signal in arm.sensors for key in IN_THE_PLANT]
    every += [f"{name}.{k}" for name in arm.known for k in arm.known[name].parameters]
    raise InputError(f"no value '{path}' in arm '{arm.name}'{did_you_mean(path, every)}")


def _bounded(arm: Arm, path: str, low: float, high: float) -> tuple[float, float]:
    """Check a range against the parameter's bounds; move its lower end off the value that would remove the effect's law."""
    parameter = arm.parameter(path)
    check_bounds(path, low, parameter)
    check_bounds(path, high, parameter)
    section, name, *_ = path.split(".")
    if section == "effects" and parameter.null is not None and low == parameter.null and _is_law(arm.known[name]):
        low += LEAST_SHARE * (high - low)
    return low, high


def _is_law(effect: type[Effect]) -> bool:
    return effect.port("structure") is None


def hash_of(name: str) -> int:
    """Hash a name to a number, the same in every process."""
    return zlib.crc32(name.encode())
