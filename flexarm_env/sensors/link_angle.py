"""The link's angle, by an encoder behind the spring of a joint or of gears."""

from __future__ import annotations

import math

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class LinkAngle(Sensor):
    """Angle of the link, or of the beam's root line, behind the spring of a joint: the hub's where there is no joint."""

    name = "link_angle"
    unit = "rad"
    label = "link angle"
    measures = "the link's angle"
    typical = math.pi
    largest = 4.0 * math.pi
    typical_offset = 0.01
    largest_offset = 10.0
    gain_spread = 0.0
    order = 12.0

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Angle of the link [rad]."""
        return Reading(position=coordinates.link)
