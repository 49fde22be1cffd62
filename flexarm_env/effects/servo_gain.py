"""Gain of a servo's firmware that differs from the stated one."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class ServoGain(Effect):
    """Gain of a servo's firmware that differs from the stated one, in proportional and derivative part alike."""

    name = "servo_gain"
    equation = "duty = c (k_p (goal − θ) − k_d ω)"
    parameters: ClassVar = {"factor": Parameter("", 0.05, 20.0, 1.5, null=1.0, meaning="c, over the stated gain")}
    looks_like = "the servo is softer or stiffer than its firmware says: it gives way more or less under load at rest"
    confused_with = ("coulomb", "saturation", "supply_sag")
    needs = ("position",)

    @staticmethod
    def structure(structure: Structure, factor: float) -> None:
        """Scale the gains of the loop."""
        structure.position_gain *= factor
        structure.rate_gain *= factor

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """A softer and a stiffer servo."""
        return [{"factor": factor} for factor in (0.6, 1.6)]
