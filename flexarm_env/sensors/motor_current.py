"""The motor's current, by a shunt or a drive's own reading."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class MotorCurrent(Sensor):
    """Current through the armature: the command behind the amplifier, or what voltage and back-EMF make of it."""

    name = "motor_current"
    unit = "A"
    label = "motor current"
    measures = "the motor's current"
    typical = 1.0
    largest = 1e3
    needs = ("motor", "amplifier")
    order = 70.0
    defaults: ClassVar = {"filter": 0.001}

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Current of the motor [A]."""
        return Reading(current=coordinates.current)
