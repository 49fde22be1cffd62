"""Constant offsets of the sensors' readings."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.plant.structure import Structure
from flexarm_env.sensors import known_sensors


class SensorOffset(Effect):
    """Constant offsets of the sensors' readings."""

    name = "sensor_offset"
    equation = "y = y_true + offset"
    parameters: ClassVar = {name: sensor.offset_parameter() for name, sensor in known_sensors().items()}
    looks_like = "a signal's error is constant, independent of motion and command"
    confused_with = ("constant_torque",)
    per_sensor = True

    @staticmethod
    def structure(structure: Structure, **offsets: float) -> None:
        """Add to the sensors' offsets."""
        for signal, channel in structure.sensors.items():
            channel.offset += offsets[signal]
