"""The `[controller]` table of a file: a control law with units."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

from flexarm_env import units
from flexarm_env.control.law import ControlLaw, Feedback, Gain
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import INPUTS
from flexarm_env.sensors import known_sensors

_GAINS = ("proportional", "integral", "derivative")
_TIMES = ("filter", "derivative_filter", "derivative_span")
#: Largest times and rates: a law keeps the readings and commands of a time. Largest commands as of a drive.
_LARGEST = {"s": 10.0, "Hz": 1e6}
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


def law_from_table(table: Any, input_kind: str) -> ControlLaw:
    """Read a `[controller]` table.

    Args:
        table: the parsed table: `limit`, `rate`, `delay`, and a table for each signal.
        input_kind: of the command, "current" or "voltage".

    Raises:
        InputError: for an unknown key, or a value that makes no sense.

    Example:
        >>> table = {"limit": "10 V", "arm_angle": {"proportional": "K1", "derivative": "4 V*s/rad"}}
        >>> law_from_table(table, "voltage").feedback[0].derivative
        (4.0,)
    """
    if not isinstance(table, Mapping):
        raise InputError("controller is not a table; write [controller.arm_angle] with proportional = …")
    unit = INPUTS[input_kind]
    own = {"limit": unit, "rate": "Hz", "delay": "s"}
    for key in table:
        if key not in own and key not in known_sensors():
            raise InputError(f"unknown key 'controller.{key}'{did_you_mean(str(key), (*own, *known_sensors()))}")
    numbers = {key: _number(f"controller.{key}", table[key], own[key]) for key in own if key in table}
    feedback = [_feedback(signal, table[signal], unit) for signal in known_sensors() if signal in table]
    if not any(gain for one in feedback for gain in one.gains.values()):
        raise InputError("controller has no gain; write [controller.arm_angle] with proportional = …")
    return ControlLaw(tuple(feedback), **numbers)


def law_table(law: ControlLaw, input_kind: str) -> dict[str, Any]:
    """Write a law as a `[controller]` table, in SI units with the unit beside each value. Defaults are left out.

    Example:
        >>> law_table(ControlLaw((Feedback("arm_angle", (6.0,)),), limit=10.0), "voltage")
        {'limit': '10.0 V', 'arm_angle': {'proportional': '6.0 V/rad'}}
    """
    unit = INPUTS[input_kind]
    table: dict[str, Any] = {}
    for key, its in (("limit", unit), ("rate", "Hz"), ("delay", "s")):
        if getattr(law, key):
            table[key] = f"{getattr(law, key)!r} {its}"
    for one in law.feedback:
        own: dict[str, Any] = {
            name: _gain_text(gain, _gain_unit(name, one.signal, unit)) for name, gain in one.gains.items() if gain
        }
        own |= {key: f"{getattr(one, key)!r} s" for key in _TIMES if getattr(one, key)}
        table[one.signal] = own
    return table


def odd_units(law: ControlLaw, conditions: Mapping[str, float], input_kind: str) -> str:
    """Describe the first conditions of units that do not make a gain's; "" for none. A factor without a unit is one of any.

    Args:
        law: with the names of conditions.
        conditions: of a recording.
        input_kind: of the command.
    """
    for one in law.feedback:
        for name, gain in one.gains.items():
            named = {factor: conditions[factor] for factor in gain if isinstance(factor, str) and factor in conditions}
            factors = [named.get(factor, 0.0) if isinstance(factor, str) else factor for factor in gain]
            stated = [factor.unit for factor in factors if isinstance(factor, units.BaseValue) and factor.unit]
            target = _gain_unit(name, one.signal, INPUTS[input_kind])
            if named and len(stated) == len(gain) and not units.product_converts(stated, target):
                listed = " × ".join(f"{key} = {value:g} {getattr(value, 'unit', '')}".rstrip() for key, value in named.items())
                return f"{listed} is controller.{one.signal}.{name}, which is in {target}"
    return ""


def _feedback(signal: str, given: Any, unit: str) -> Feedback:
    where = f"controller.{signal}"
    if not isinstance(given, Mapping):
        raise InputError(f"{where} is not a table; write [{where}]")
    for key in given:
        if key not in (*_GAINS, *_TIMES):
            raise InputError(f"unknown key '{where}.{key}'{did_you_mean(str(key), (*_GAINS, *_TIMES))}")
    values: dict[str, Any] = {
        key: _gain(f"{where}.{key}", given[key], _gain_unit(key, signal, unit)) for key in _GAINS if key in given
    }
    values |= {key: _number(f"{where}.{key}", given[key], "s") for key in _TIMES if key in given}
    return Feedback(signal, **values)


def _gain_unit(name: str, signal: str, unit: str) -> str:
    """Make the unit of a gain in command per signal, per second or times second."""
    its = known_sensors()[signal].unit
    its = its if its.isalpha() else f"({its})"
    return {"proportional": f"{unit}/{its}", "integral": f"{unit}/{its}/s", "derivative": f"{unit}*s/{its}"}[name]


def _gain(where: str, given: Any, unit: str) -> Gain:
    """Read a gain: a number in SI, a quantity, the name of a condition, or a list of them that are multiplied."""
    if isinstance(given, list):
        if not given:
            raise InputError(f"{where} is an empty list; write the factors of the gain, such as ['kp', 'kv']")
        return tuple(_factor(where, one, unit, alone=False) for one in given)
    return (_factor(where, given, unit, alone=True),)


def _factor(where: str, given: Any, unit: str, alone: bool) -> float | str:
    if isinstance(given, str) and not units.is_quantity(given):
        if _NAME.fullmatch(given):
            return given
        raise InputError(f"{where} = {given!r}; write a number, '0.5 {unit}', or the name of a condition such as 'K1'")
    if isinstance(given, bool) or not isinstance(given, int | float | str):
        raise InputError(f"{where} = {given!r}; write a number, '0.5 {unit}', or the name of a condition such as 'K1'")
    try:
        number = units.quantity(given, unit) if alone or not isinstance(given, str) else units.base_value(given)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    if not math.isfinite(number):
        raise InputError(f"{where} is {number}; write a finite number")
    return number


def _number(where: str, given: Any, unit: str) -> float:
    if isinstance(given, bool) or not isinstance(given, int | float | str):
        raise InputError(f'{where} = {given!r} is no number; write 0.5 or "0.5 {unit}"')
    try:
        number = units.quantity(given, unit)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    if not 0.0 <= number <= _LARGEST.get(unit, 1e6):
        raise InputError(f"{where} = {number:g} {unit} is out of bounds: allowed are 0 to {_LARGEST.get(unit, 1e6):g} {unit}")
    return number


def _gain_text(gain: Gain, unit: str) -> Any:
    if len(gain) > 1:
        return [_factor_text(factor) for factor in gain]
    return gain[0] if isinstance(gain[0], str) else f"{float(gain[0])!r} {unit}"


def _factor_text(factor: float | str) -> float | str:
    stated = factor.unit if isinstance(factor, units.BaseValue) else ""
    return f"{float(factor)!r} {stated}" if stated else factor
