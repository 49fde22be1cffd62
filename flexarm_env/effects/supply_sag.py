"""A supply whose voltage sags under the motor's current."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class SupplySag(Effect):
    """A supply whose voltage sags under the motor's current: cable, battery and bridge have a resistance."""

    name = "supply_sag"
    equation = "i = (d U − k ω) / (R + d² R_s), duty d"
    parameters: ClassVar = {"resistance": Parameter("ohm", 0.0, 1e3, 0.5, null=0.0, meaning="R_s, of supply and cable")}
    looks_like = "at large commands the torque falls short, most at rest"
    confused_with = ("saturation", "servo_gain", "viscous")
    source = "power balance of a bridge at duty d: the supply carries d i"
    needs = ("supply",)

    @staticmethod
    def structure(structure: Structure, resistance: float) -> None:
        """Add to the resistance of the supply."""
        structure.supply_resistance += resistance
