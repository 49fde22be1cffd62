"""The sensors: one file for each signal in this folder, and those that others register."""

from __future__ import annotations

from flexarm_env.plant.reading import Coordinates, Reading
from flexarm_env.sensors.base import Sensor, StrainGage
from flexarm_env.sensors.catalogue import known_sensors

__all__ = ["Coordinates", "Reading", "Sensor", "StrainGage", "known_sensors"]
