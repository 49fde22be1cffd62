"""A factor in words: its size, the known number that it equals, and the line that mends it."""

from __future__ import annotations

import math

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault
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
#: Edges that a decoder counts for each line of an encoder.
QUADRATURE = 4


def factor_fault(evidence: Evidence, signal: str, value: float, rival: str = "", roughly: bool = False) -> Fault:
    """Describe the factor of a signal or of the command, over the model's.

    Args:
        evidence: on the recording.
        signal: at fault, or the command.
        value: the factor.
        rival: that could be at fault in its place.
        roughly: whether the model is wrong elsewhere, too, so that the value is no more than an estimate.
    """
    recording = evidence.recording
    size = f"about {value:.2g}" if roughly else f"{value:.3g}"
    unit, number = ("", "") if roughly else _known(evidence, signal, value)
    size += f" = {number}" if number else ""
    also = f" (or {rival} is {1.0 / value:.3g} of it: with one signal alone the two look alike)" if rival else ""
    entry = f'unit = "{unit}"' if unit else f"scale = {1.0 / value:.4g}"
    gain = ""
    if signal in evidence.signals and evidence.arm.parameter(f"sensors.{signal}.gain").spread and not unit:
        gain = f", or in the arm file [sensors.{signal}] gain = {value * evidence.arm.value(f'sensors.{signal}.gain'):.4g}"
    return Fault(
        recording=recording.name,
        source=recording.source,
        signal=signal,
        kind="factor",
        value=value,
        unit="",
        message=f"{signal} is {size} of the model's{also}",
        hint=f"{signal} = {{ {entry} }}{gain}",
        other=rival,
    )


def _known(evidence: Evidence, signal: str, value: float) -> tuple[str, str]:
    """Look up the unit and the number in words that a factor equals; empty where there is none."""
    close = evidence.numbers.known_factor
    unit = INPUTS.get(signal) or evidence.arm.sensor(signal).unit
    for other, words in USUAL_UNITS.get(unit, {}).items():
        if abs(math.log(value * unit_factor(other, unit))) < close:
            return other, words
    ratio = evidence.arm.constants["drive"]["gear_ratio"]
    sides = {"the gear ratio": ratio, "1/(gear ratio)": 1.0 / ratio}
    counts = {"4 (edges of an encoder for its lines)": QUADRATURE, "1/4 (lines of an encoder for its edges)": 1.0 / QUADRATURE}
    numbers = {"arm_angle": sides | counts, "motor_speed": sides}
    for words, number in numbers.get(signal, {}).items():
        if abs(math.log(value / number)) < close and abs(math.log(number)) > close:
            return "", words
    return "", ""
