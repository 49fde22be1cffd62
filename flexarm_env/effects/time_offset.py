"""Offset between two clocks: measurements stamped later, or earlier, than the commands."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class TimeOffset(Effect):
    """Offset between two clocks: measurements stamped later, or earlier, than the commands."""

    name = "time_offset"
    equation = "y(t) = y_true(t − d)"
    parameters: ClassVar = {"offset": Parameter("s", -0.5, 0.5, 0.006, null=0.0, meaning="d, positive: measured late")}
    looks_like = "all signals are shifted in time against the command, even before it"
    confused_with = ("input_delay", "current_lag")

    @staticmethod
    def structure(structure: Structure, offset: float) -> None:
        """Shift the command, which in a replay is the same as shifting the measurements."""
        structure.input_delay += offset

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Both signs."""
        return [{"offset": offset} for offset in (-0.01, -0.003, 0.003, 0.01)]
