"""Which sensors exist: those of this folder and of the entry-point group `flexarm_env.sensors`."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Mapping
from functools import lru_cache
from importlib.metadata import entry_points
from types import MappingProxyType

from flexarm_env.sensors.base import Sensor
from flexarm_env.sensors.checks import checked


@lru_cache(maxsize=1)
def known_sensors() -> Mapping[str, type[Sensor]]:
    """Collect the sensors by the name of their signal, in the usual order of the signals."""
    package = importlib.import_module("flexarm_env.sensors")
    found: list[type[Sensor]] = []
    for module in pkgutil.iter_modules(package.__path__):
        if module.name not in ("base", "catalogue", "checks"):
            found += _sensors_in(importlib.import_module(f"flexarm_env.sensors.{module.name}"))
    found += [point.load() for point in entry_points(group="flexarm_env.sensors")]
    ordered = sorted(map(checked, found), key=lambda sensor: (sensor.order, sensor.name))
    return MappingProxyType({sensor.name: sensor for sensor in ordered})


def _sensors_in(module: object) -> list[type[Sensor]]:
    return [
        member
        for member in vars(module).values()
        if inspect.isclass(member) and issubclass(member, Sensor) and "name" in vars(member)
    ]
