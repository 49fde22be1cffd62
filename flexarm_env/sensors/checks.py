"""Whether a class is a sensor that an arm can have."""

from __future__ import annotations

import inspect
import math

from flexarm_env.arm_sections import SENSOR
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import INPUTS, NEEDS
from flexarm_env.sensors.base import Sensor

#: Names that a signal cannot have: other columns of recordings, and names in the needs of effects.
TAKEN = ("time", "reference", "strain", *INPUTS, *NEEDS)


def checked(sensor: type[Sensor]) -> type[Sensor]:
    """Check that a sensor is whole, and return it.

    Raises:
        InputError: for an attribute that is missing or impossible.
    """
    where = f"sensor {sensor.__name__}"
    for attribute in ("name", "unit", "label"):
        if not isinstance(getattr(sensor, attribute, None), str):
            raise InputError(f"{where} lacks '{attribute}', a text")
    if not (sensor.name.isidentifier() and sensor.name.isascii()) or sensor.name in TAKEN:
        raise InputError(f"{where}: name is {sensor.name!r}; write letters, digits and _, and none of {', '.join(TAKEN)}")
    if sensor.reading is Sensor.reading:
        raise InputError(f"{where} lacks 'reading'; write @staticmethod, def reading(coordinates)")
    if len(inspect.signature(sensor.reading).parameters) != 1:
        raise InputError(f"{where}: reading takes one argument, coordinates; write it with @staticmethod")
    if not (math.isfinite(sensor.typical) and 0.0 < sensor.typical <= sensor.range_end()):
        raise InputError(f"{where}: typical = {sensor.typical!r}; give a positive number, at most 'largest'")
    if isinstance(sensor.needs, str):
        raise InputError(f'{where}: needs is a text; write needs = ("{sensor.needs}",)')
    for key, allowed in (*((key, (*NEEDS, *INPUTS)) for key in sensor.needs), *((key, SENSOR) for key in sensor.defaults)):
        if key not in allowed:
            raise InputError(f"{where}: unknown '{key}'{did_you_mean(key, allowed)}")
    return sensor
