"""The hub's angle, by a potentiometer or an encoder."""

from __future__ import annotations

import math

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class ArmAngle(Sensor):
    """Angle of the hub, on the arm's side of the gears."""

    name = "arm_angle"
    unit = "rad"
    label = "arm angle"
    measures = "the arm's angle"
    typical = math.pi
    largest = 4.0 * math.pi
    typical_offset = 0.01
    largest_offset = 10.0
    gain_spread = 0.0
    order = 10.0

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Angle of the hub [rad]."""
        return Reading(position=coordinates.hub)
