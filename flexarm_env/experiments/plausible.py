"""Refuse a motion beyond any arm's, as a wrong unit or an impossible value of the model makes it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.parameters import INPUTS
from flexarm_env.recordings.checks import LARGEST_READING

Floats = NDArray[np.float64]

#: A value of an effect is named as a possible cause where it is so many times its typical one, or as small a part of it.
FAR_FROM_TYPICAL = 100.0


def check_motion(arm: Arm, name: str, time: Floats, commands: Floats, readings: Floats) -> None:
    """Refuse modelled readings that are not finite, or beyond any that a recording may hold.

    Args:
        arm: the model.
        name: of the recording.
        time: (samples,) [s].
        commands: (samples,) [A or V].
        readings: (samples, signals) of the model, SI units.

    Raises:
        InputError: naming the first signal beyond, the time, and the likely causes.

    Example:
        >>> import numpy as np
        >>> from flexarm_env import Arm
        >>> arm, time = Arm.load("cu-rigid"), np.array([0.0, 0.1])
        >>> check_motion(arm, "run", time, np.ones(2), np.array([[0.0, 0.0], [0.0, 1e9]]))
        Traceback (most recent call last):
        ...
        flexarm_env.errors.InputError: run: motor_speed of the model of arm 'cu-rigid' leaves ±1e+07 rad/s at 0.1 s under \
commands of up to 1 V (limit 10 V); is a unit wrong, or a value of the arm?
    """
    beyond = ~(np.abs(readings) <= LARGEST_READING)
    if not beyond.any():
        return
    row = int(beyond.any(axis=1).argmax())
    signal = arm.signals[int(beyond[row].argmax())]
    largest, limit, unit = float(np.abs(commands).max()), arm.constants["drive"]["limit"], INPUTS[arm.input]
    allowed = f" (limit {limit:g} {unit})" if limit else ""
    raise InputError(
        f"{name}: {signal} of the model of arm '{arm.name}' leaves ±{LARGEST_READING:g} {arm.sensor(signal).unit} "
        f"at {time[row]:.3g} s under commands of up to {largest:g} {unit}{allowed}; "
        f"is a unit wrong, or a value of the arm?{_far_value(arm)}"
    )


def _far_value(arm: Arm) -> str:
    """Name the effect's value that is farthest from its typical size; "" where none is far."""
    distances: dict[str, float] = {}
    for name, values in arm.present():
        for key, value in values.items():
            typical = arm.known[name].parameters[key].typical
            if value and typical and math.isfinite(value):
                distances[f"effects.{name}.{key}"] = abs(math.log(abs(value / typical)))
    path = max(distances, key=lambda path: distances[path], default="")
    if not path or distances[path] < math.log(FAR_FROM_TYPICAL):
        return ""
    parameter = arm.parameter(path)
    return f" {path} = {arm.value(path):g} {parameter.unit}, typically {parameter.typical:g}".rstrip()
