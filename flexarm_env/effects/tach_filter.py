"""A low-pass filter in the tachometer or behind it."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class TachFilter(Effect):
    """A low-pass filter in the tachometer or behind it."""

    name = "tach_filter"
    equation = "t_f dy/dt + y = ω"
    parameters: ClassVar = {"time": Parameter("s", 0.0, 1.0, 0.01, null=0.0, meaning="t_f, time constant")}
    looks_like = "speed alone lags and lacks its fast part; angle and strain fit"
    confused_with = ("time_offset",)
    needs = ("motor_speed",)

    @staticmethod
    def structure(structure: Structure, time: float) -> None:
        """Add to the filter of the tachometer."""
        structure.sensors["motor_speed"].filter += time
