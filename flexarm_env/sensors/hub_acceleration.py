"""The hub's angular acceleration, by a rate sensor's derivative or two accelerometers."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class HubAcceleration(Sensor):
    """Angular acceleration of the hub."""

    name = "hub_acceleration"
    unit = "rad/s**2"
    label = "hub acceleration"
    typical = 50.0
    largest = 1e4
    order = 60.0
    defaults: ClassVar = {"filter": 0.001}

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Angular acceleration of the hub [rad/s²]."""
        return Reading(acceleration=coordinates.hub)
