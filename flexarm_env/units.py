"""Conversion of quantities with units, such as "0.0116 rad", to SI numbers, by pint."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Sequence
from numbers import Real
from typing import TYPE_CHECKING

from flexarm_env.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import pint

# A whitelist, because pint evaluates its input: "V**9**9**9" would not return.
_TERM = r"[A-Za-zµμΩ°]+(?:_[A-Za-z]+)*(?: *(?:\^|\*\*) *-?\d|[²³])?"
_GROUP = rf"\({_TERM}(?: *[*/·] *{_TERM}| +{_TERM})*\)(?:(?:\^|\*\*)-?\d|[²³])?"
_FACTOR = rf"(?:{_TERM}|{_GROUP})"
_UNIT = re.compile(rf"(?:1 */ *)?{_FACTOR}(?: *[*/·] *{_FACTOR}| +{_FACTOR})*")
# No digit may follow the number, lest "2 000" be read as 2, but for a unit such as 1/s that stands apart; nor an e without an
# exponent, lest "4e" be elementary charges. Possessive, so that no text takes time that grows faster than its length.
_NUMBER = r"[+-]?(?:\d++(?>(?:\.\d*+)?)|\.\d++)(?:[eE][+-]?\d++|(?![eE](?![A-Za-z])))"
_QUANTITY = re.compile(rf"({_NUMBER})(?>(?:(?:\s++(?=1 */)|\s*+(?=[^\d\s.,:;-]))(.*+))?)")
_LONGEST = 60
#: Power of a length in a torque, and in a voltage.
_LENGTHS_OF_TORQUE = 2
_PERCENT = ("%", "percent")
# Without these pint reads Nm as "number metre", a count of yarn, and the others not at all.
_COMPOUNDS = (
    "newton_meter = newton * meter = Nm",
    "newton_meter_second = newton * meter * second = Nms",
    "volt_second = volt * second = Vs",
    "ampere_second = ampere * second = As",
)
_COMMON = {
    "s": ("s", "ms", "us", "min"),
    "A": ("A", "mA"),
    "V": ("V", "mV"),
    "rad": ("rad", "mrad", "deg", "turn"),
    "rad/s": ("rad/s", "deg/s", "rpm"),
    "m": ("m", "mm", "cm"),
    "kg": ("kg", "g"),
}


@functools.cache
def _registry() -> pint.UnitRegistry[float]:
    import pint  # a quarter of a second, which files in SI units need not pay

    # Nm takes the place of pint's own on purpose, which pint would otherwise warn of.
    registry: pint.UnitRegistry[float] = pint.UnitRegistry(on_redefinition="ignore")
    for definition in _COMPOUNDS:
        registry.define(definition)
    registry.define("@alias turn = rev")
    return registry


def _allowed(target: str) -> str:
    common = _COMMON.get(target)
    return f"write one of {', '.join(common)}" if common else f"write a unit that converts to {target}"


@functools.lru_cache(maxsize=256)
def _parse(text: str, target: str) -> pint.Unit:
    """Parse a unit; `target` only serves the message."""
    import pint

    if len(text) <= _LONGEST and _UNIT.fullmatch(text):
        try:
            return _registry().parse_units(text)
        except (pint.PintError, ValueError):
            pass
    common = _COMMON.get(target, ())
    hint = did_you_mean(text.lower(), common) if common else f"; {_allowed(target)}"
    raise InputError(f"unknown unit {text[:_LONGEST]!r}{hint}")


def _angle_power(unit: pint.Unit) -> float:
    root = _registry().Quantity(1.0, unit).to_root_units()
    return next((float(power.real) for name, power in root.unit_items() if name == "radian"), 0.0)


def _same_kind(unit: pint.Unit, target: pint.Unit) -> bool:
    """Compare the quantities that two units measure.

    Pint treats an angle as a bare number, and would take Hz for rad/s without the factor 2π. Powers of the radian must
    therefore agree, except where a torque or a voltage is related to motion: Nm for Nm/rad is customary, V·s/rad for Nm/A.
    """
    if unit.dimensionality != target.dimensionality:
        return False
    lengths = next((abs(float(power.real)) for name, power in target.dimensionality.items() if name == "[length]"), 0.0)
    has_torque = "[mass]" in target.dimensionality and lengths >= _LENGTHS_OF_TORQUE
    is_related = _angle_power(target) != 0.0 or target.dimensionality not in _torque_and_voltage()
    customary = has_torque and is_related and "hertz" not in str(unit)
    return customary or _angle_power(unit) == _angle_power(target)


@functools.cache
def _torque_and_voltage() -> tuple[object, ...]:
    return tuple(_registry().Unit(name).dimensionality for name in ("Nm", "V"))


def converts(unit: str, target: str) -> bool:
    """Whether a unit converts to another.

    Raises:
        InputError: for an unknown unit.

    Example:
        >>> converts("rpm", "rad/s"), converts("Hz", "rad/s")
        (True, False)
    """
    return unit == target or _same_kind(_parse(unit, target), _parse(target, target))


def factor(unit: str, target: str, scale: str | float = 1.0) -> float:
    """Compute the factor that converts numbers of one unit to another.

    Args:
        unit: of the numbers, such as "deg" or "V".
        target: unit of the result, such as "rad".
        scale: another factor, a number or a quantity such as "2 rad/V"; its unit counts.

    Raises:
        InputError: for an unknown unit, a unit of another quantity, or one with another zero, such as degC.

    Example:
        >>> factor("ms", "s"), factor("V", "rad", scale="2 rad/V")
        (0.001, 2.0)
    """
    number, scale_unit = (float(scale), "") if isinstance(scale, (int, float)) else split(scale)
    if unit == target and not scale_unit:
        return number
    goal = _parse(target, target)
    source = _parse(unit, target)
    shown = unit
    if scale_unit:
        source = _registry().Unit(source * _parse(scale_unit, f"{target} per {unit}"))
        shown = f"{unit} × {scale_unit}"
    if not _same_kind(source, goal) or _registry().Quantity(0.0, source).to(goal).magnitude != 0.0:
        raise InputError(f"unit '{shown}' does not convert to {target}; {_allowed(target)}")
    return number * float(_registry().Quantity(1.0, source).to(goal).magnitude)


def is_unit(text: str) -> bool:
    """Whether a text is a unit.

    Example:
        >>> is_unit("rad/s"), is_unit("0.5"), is_unit("arm")
        (True, False, False)
    """
    try:
        _parse(text, text)
    except InputError:
        return False
    return True


def are_equal(one: str, other: str) -> bool:
    """Whether two texts are one unit, such as "V" and "volt".

    Raises:
        InputError: for an unknown unit.
    """
    return _parse(one, other) == _parse(other, other)


def check_unit(unit: str) -> None:
    """Refuse a unit, stated by a program and not by a file, that pint does not know.

    Raises:
        InputError: for an unknown unit.
    """
    import pint

    try:
        _registry().parse_units(unit)
    except (pint.PintError, ValueError):
        raise InputError(f"unknown unit {unit[:_LONGEST]!r}; write one that pint knows, such as N*m/rad") from None


def as_float(value: float) -> float:
    """Convert a number to a float, a whole number beyond the range of floats to infinity."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def is_finite(value: object) -> bool:
    """Whether a value is a real number within the range of floats.

    Example:
        >>> is_finite(3), is_finite(10**400), is_finite("3")
        (True, False, False)
    """
    try:
        return isinstance(value, Real) and math.isfinite(value)
    except OverflowError:
        return False


def is_quantity(text: str) -> bool:
    """Whether a text has the form of a number, alone or with a unit, known or not.

    Example:
        >>> is_quantity("0.3 kg"), is_quantity("three")
        (True, False)
    """
    match = _QUANTITY.fullmatch(text.strip())
    return bool(match and (not match[2] or (len(match[2]) <= _LONGEST and _UNIT.fullmatch(match[2]))))


def split(text: str, target: str = "kg") -> tuple[float, str]:
    """Split a quantity into number and unit, "" for none; the target serves the message alone.

    Raises:
        InputError: for a text of another form, or a number that is not finite.

    Example:
        >>> split("9.0 1/rad")
        (9.0, '1/rad')
    """
    match = _QUANTITY.fullmatch(text.strip())
    if match is None or not math.isfinite(float(match[1])):
        raise InputError(f"{text[:_LONGEST]!r} is not a number with a unit; write for example '{f'0.3 {target}'.rstrip()}'")
    return float(match[1]), match[2] or ""


def quantity(value: str | float, target: str) -> float:
    """Convert a quantity to a unit.

    Args:
        value: a text such as "0.0116 rad", or a number, which is already in `target`.
        target: unit of the result; "" for a bare number.

    Raises:
        InputError: for a text that is not a number with a unit, or a unit that does not convert to `target`.

    Example:
        >>> quantity("300 g", "kg"), quantity(0.3, "kg")
        (0.3, 0.3)
    """
    if not isinstance(value, str):
        return as_float(value)
    number, unit = split(value, target)
    if unit and not target:
        bare = number / 100.0 if unit in _PERCENT else number
        raise InputError(f"unit '{unit}' on a bare number; write {bare:g}")
    return number * factor(unit, target) if unit else number


class BaseValue(float):
    """A number in SI base units, with these beside it.

    Attributes:
        unit: such as "kg" or "V/rad"; "" where none was stated.

    Example:
        >>> BaseValue(0.3, "kg").unit, BaseValue(0.3, "kg") + 1.0
        ('kg', 1.3)
    """

    unit: str

    def __new__(cls, number: float, unit: str = "") -> BaseValue:
        """Make a number of a unit, whose own factor to SI's base units is 1."""
        made = super().__new__(cls, number)
        made.unit = unit
        return made


def base_value(text: str) -> BaseValue:
    """Convert a quantity to SI base units; a number without a unit is kept.

    Raises:
        InputError: for a text that is not a number with a unit, or an unknown unit.

    Example:
        >>> base_value("20 degC"), base_value("300 g").unit, base_value("6 mV/deg").unit
        (293.15, 'kg', 'V/rad')
    """
    number, unit = split(text)
    return in_base(number, unit)


def in_base(number: float, *stated: str) -> BaseValue:
    """Convert a number of a unit, or of a product of units, to SI base units; "" is none.

    Raises:
        InputError: for an unknown unit, or a product with one of another zero, such as degC.

    Example:
        >>> in_base(2.0, "rad/V", "mV"), in_base(2.0, "rad/V", "mV").unit
        (0.002, 'rad')
    """
    import pint

    parsed = [_parse(unit, "SI") for unit in stated if unit]
    if not parsed:
        return BaseValue(number)
    try:
        product = _registry().Unit(math.prod(parsed[1:], start=parsed[0]))
        found = _registry().Quantity(number, product).to_base_units()
    except pint.PintError:
        raise InputError(f"{' × '.join(stated)} is no unit; {_allowed('SI')}") from None
    coherent = _coherent(product)
    written = [unit for unit in stated if unit]
    text = written[0] if len(written) == 1 and coherent == product else f"{coherent:~C}".replace("Ω", "ohm")
    return BaseValue(float(found.magnitude), text)


def _coherent(unit: pint.Unit) -> pint.Unit:
    """Take off prefixes, and replace units of other systems, so that a number is that in base units: V/rad for mV/deg."""
    registry = _registry()

    def is_coherent(name: str) -> bool:
        return all(registry.Quantity(number, name).to_base_units().magnitude == number for number in (0.0, 1.0))

    found = registry.Unit("")
    for name, power in registry.Quantity(1.0, unit).unit_items():
        names = (name, registry.parse_unit_name(name)[0][1])
        own = next(filter(is_coherent, names), None)
        base = registry.Unit(own) if own else registry.Quantity(1.0, name).to_base_units().units
        found = registry.Unit(found * base**power)
    return found


def product_converts(units: Sequence[str], target: str) -> bool:
    """Whether a product of units converts to another unit.

    Raises:
        InputError: for an unknown unit.

    Example:
        >>> product_converts(["1/s", "V*s/rad"], "V/rad"), product_converts(["A/rad"], "V/rad")
        (True, False)
    """
    product = math.prod((_parse(unit, target) for unit in units), start=_registry().Unit(""))
    return _same_kind(_registry().Unit(product), _parse(target, target))
