"""The deflection of the beam's tip, by a camera or a laser that turns with the hub."""

from __future__ import annotations

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class TipDeflection(Sensor):
    """Deflection of the tip from the hub's line."""

    name = "tip_deflection"
    unit = "m"
    label = "tip deflection"
    measures = "the tip's sensor"
    typical = 0.2
    largest = 2.0
    typical_offset = 0.005
    largest_offset = 10.0
    needs = ("beam",)
    order = 50.0

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Deflection of the tip [m]."""
        return Reading(position=coordinates.deflection(coordinates.length))
