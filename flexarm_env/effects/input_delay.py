"""Delay of the command, as from computing time or a bus."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class InputDelay(Effect):
    """Delay of the command, as from computing time or a bus."""

    name = "input_delay"
    equation = "i(t) = command(t − d)"
    parameters: ClassVar = {"delay": Parameter("s", 0.0, 0.5, 0.006, null=0.0, meaning="d")}
    looks_like = "all signals respond late by the same time, undistorted"
    confused_with = ("time_offset", "current_lag")

    @staticmethod
    def structure(structure: Structure, delay: float) -> None:
        """Add to the delay of the command."""
        structure.input_delay += delay

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """A few delays: the error has a local minimum at each period of the beam."""
        return [{"delay": delay} for delay in (0.003, 0.01, 0.03)]
