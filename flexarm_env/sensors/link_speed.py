"""The link's speed, behind the spring of a joint or of gears."""

from __future__ import annotations

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class LinkSpeed(Sensor):
    """Speed of the link, behind the spring of a joint: the hub's where there is no joint."""

    name = "link_speed"
    unit = "rad/s"
    label = "link speed"
    measures = "the link's speed"
    typical = 5.0
    largest = 200.0
    typical_offset = 0.1
    largest_offset = 1e3
    gain_spread = 0.03
    order = 22.0

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Speed of the link [rad/s]."""
        return Reading(speed=coordinates.link)
