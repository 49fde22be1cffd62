"""First-order lag of the amplifier's current behind the command."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class CurrentLag(Effect):
    """First-order lag of the amplifier's current behind the command."""

    name = "current_lag"
    equation = "t_l di/dt + i = command"
    parameters: ClassVar = {"time": Parameter("s", 0.0, 1.0, 0.01, null=0.0, meaning="t_l, time constant")}
    looks_like = "all signals follow fast commands late and smoothed"
    confused_with = ("input_delay", "time_offset", "rate_limit")
    needs = ("amplifier",)

    @staticmethod
    def structure(structure: Structure, time: float) -> None:
        """Add to the lag of the current."""
        structure.current_lag += time
