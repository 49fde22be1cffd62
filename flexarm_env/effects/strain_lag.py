"""A low-pass filter in the strain gages' amplifiers."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class StrainLag(Effect):
    """A low-pass filter in the strain gages' amplifiers."""

    name = "strain_lag"
    equation = "t_f dy/dt + y = strain"
    parameters: ClassVar = {"time": Parameter("s", 0.0, 1.0, 0.01, null=0.0, meaning="t_f, time constant")}
    looks_like = "both strain signals lag and lack their fast part; angle and speed fit"
    confused_with = ("beam_damping",)
    needs = ("strain",)

    @staticmethod
    def structure(structure: Structure, time: float) -> None:
        """Add to the filters of the strain gages."""
        for channel in structure.sensors.values():
            if channel.strain:
                channel.filter += time
