"""A factor in words: its size, the known number that it equals, and the line that mends it."""

from __future__ import annotations

import math

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault
from flexarm_env.parameters import INPUTS
from flexarm_env.units import factor as unit_factor

#: Units in which people record a quantity of an SI unit, and their number in one SI unit, in words.
USUAL_UNITS = {
    "rad": {"deg": "180/π", "turn": "1/(2π)", "mrad": "1000"},
    "rad/s": {"rps": "1/(2π)", "rpm": "60/(2π)", "deg/s": "180/π"},
    "A": {"mA": "1000"},
    "V": {"mV": "1000"},
    "m": {"mm": "1000", "cm": "100"},
}
#: Edges that a decoder counts for each line of an encoder: unit, words and number.
QUADRATURE = (("", "4 (edges of an encoder for its lines)", 4), ("", "1/4 (lines of an encoder for its edges)", 1 / 4))
#: Numbers by which quantities are off from each other: turns, minutes, halves, decades.
USUAL_NUMBERS = tuple(
    ("", words, number)
    for plain, below, one in (
        ("2", "2", 2),
        ("4", "4", 4),
        ("10", "10", 10),
        ("100", "100", 100),
        ("1000", "1000", 1000),
        ("2π", "(2π)", math.tau),
        ("60/(2π)", "(60/(2π))", 60 / math.tau),
        ("180/π", "(180/π)", 360 / math.tau),
    )
    for words, number in ((plain, one), (f"1/{below}", 1 / one))
)
#: Factors from here on are written without digits behind the point.
LARGE = 100


def factor_fault(evidence: Evidence, signal: str, value: float, rival: str = "", roughly: bool = False) -> Fault:
    """Describe the factor of a signal or of the command, over the model's.

    Args:
        evidence: on the recording.
        signal: at fault, or the command.
        value: the factor.
        rival: that could be at fault in its place.
        roughly: whether the model is wrong elsewhere, too, so that the value is no more than an estimate.
    """
    # The constants of the model, too, change the factor of a command, of an only signal, or beside a wrong model.
    numbers, is_rough = evidence.numbers, roughly or bool(rival) or signal in INPUTS
    unit, words, number = _known(evidence, signal, value, is_rough)
    size = f"about {_number(value)}" if is_rough else _number(value)
    if words:
        size += f" = {words}" if abs(math.log(value / number)) < numbers.known_factor else f", probably {words}"
    also = f" (or {rival} is {_number(1.0 / value)} of it: with one signal alone the two look alike)" if rival else ""
    entry = f'unit = "{unit}"' if unit else f"scale = {1.0 / number:.4g}"
    gain = ""
    if signal in evidence.signals and evidence.arm.parameter(f"sensors.{signal}.gain").spread and not words:
        gain = f", or in the arm file [sensors.{signal}] gain = {value * evidence.arm.value(f'sensors.{signal}.gain'):.4g}"
    text, hint = f"is {size} of the model's{also}", f"{signal} = {{ {entry} }}{gain}"
    return fault(evidence.recording, signal, "factor", number, text, hint, other=rival)


def is_of_unit(command: str, factor: float) -> bool:
    """Whether the factor of a command is that of a unit in which people record it."""
    return any(math.isclose(factor, number) for _, _, number in _units(INPUTS[command]))


def _number(value: float) -> str:
    """Write a factor with three digits, and without an exponent if it is large."""
    rounded = f"{value:.3g}"
    return f"{float(rounded):.0f}" if abs(value) >= LARGE else rounded


def _known(evidence: Evidence, signal: str, value: float, is_rough: bool) -> tuple[str, str, float]:
    """Look up the unit that a factor stands for and the known number that it equals, in words and as a number, or itself.

    Any usual number may be meant by a factor that is known roughly; an exact one must be that of a unit, the gear or the encoder.
    """
    close = evidence.numbers.likely_factor if is_rough else evidence.numbers.known_factor
    unit = INPUTS.get(signal) or evidence.arm.sensor(signal).unit
    ratio = evidence.arm.constants["drive"]["gear_ratio"]
    sides = [("", "the gear ratio", ratio), ("", "1/(gear ratio)", 1.0 / ratio)] if ratio != 1.0 else []
    own = {"arm_angle": [*sides, *QUADRATURE], "motor_speed": sides}.get(signal, [])
    known = [*_units(unit), *own, *(USUAL_NUMBERS if is_rough else ())]
    unit, words, number = min(known, key=lambda one: abs(math.log(value / one[2])), default=("", "", value))
    return (unit, words, number) if abs(math.log(value / number)) < close else ("", "", value)


def _units(unit: str) -> list[tuple[str, str, float]]:
    """List the other units of a quantity, with the number of each in one SI unit, in words and as a number."""
    return [(other, words, 1.0 / unit_factor(other, unit)) for other, words in USUAL_UNITS.get(unit, {}).items()]
