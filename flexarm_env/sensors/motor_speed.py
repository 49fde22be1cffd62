"""The motor's speed, by a tachometer."""

from __future__ import annotations

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor


class MotorSpeed(Sensor):
    """Speed of the motor's shaft: the gear ratio times the hub's where the gears are stiff."""

    name = "motor_speed"
    unit = "rad/s"
    label = "motor speed"
    measures = "the motor's speed"
    typical = 5.0
    largest = 200.0
    typical_offset = 0.1
    largest_offset = 1e3
    gain_spread = 0.03
    motor_side = True
    order = 20.0

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Speed of the motor's shaft [rad/s]."""
        return Reading(speed=coordinates.motor)
