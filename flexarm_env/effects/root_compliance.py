"""Compliance of the clamp at the hub under the beam's bending moment."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class RootCompliance(Effect):
    """Compliance of the clamp at the hub under the beam's bending moment."""

    name = "root_compliance"
    equation = "root slope = C · moment"
    parameters: ClassVar = {
        "compliance": Parameter("rad/N/m", 0.0, 1e4, 0.005, null=0.0, meaning="C, slope per moment at the root")
    }
    looks_like = "all frequencies lie low, the clamped one the most"
    confused_with = ("payload", "higher_modes", "gear_compliance")
    needs = ("beam",)

    @staticmethod
    def structure(structure: Structure, compliance: float) -> None:
        """Let the root of the beam turn against the hub."""
        structure.root_compliance += compliance
