"""The acceleration of the beam's tip."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class TipAcceleration(Sensor):
    """Accelerometer at the beam's tip, across the beam."""

    name = "tip_acceleration"
    unit = "m/s**2"
    label = "tip acceleration"
    typical = 10.0
    largest = 1e3
    needs = ("beam",)
    order = 62.0
    defaults: ClassVar = {"filter": 0.001}

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Acceleration of the tip across the beam [m/s²]."""
        return Reading(acceleration=coordinates.displacement(coordinates.length))
