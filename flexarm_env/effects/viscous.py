"""Friction proportional to speed."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class Viscous(Effect):
    """Friction proportional to speed."""

    name = "viscous"
    equation = "T = b ω"
    parameters: ClassVar = {
        "coefficient": Parameter("N*m*s", 0.0, 1e5, 0.05, null=0.0, spread=0.5, meaning="friction per speed, arm side")
    }
    looks_like = "the hub coasts down along an exponential; missing torque grows with speed, through zero"
    confused_with = ("air_drag", "asymmetric_viscous")
    source = "thesis eqs. 2.1 and 3.9"

    @staticmethod
    def structure(structure: Structure, coefficient: float) -> None:
        """Add to the viscous friction."""
        structure.viscous += coefficient
