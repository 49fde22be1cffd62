"""Inertia of a payload about the tip."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class TipInertia(Effect):
    """Inertia of a payload about the tip."""

    name = "tip_inertia"
    equation = "M(slope, slope) += J"
    parameters: ClassVar = {"inertia": Parameter("kg*m**2", 0.0, 1e3, 0.002, null=0.0, meaning="J, about the tip")}
    looks_like = "the higher modes lie low while the first stays"
    confused_with = ("payload", "root_compliance", "higher_modes")
    needs = ("beam",)

    @staticmethod
    def structure(structure: Structure, inertia: float) -> None:
        """Add to the inertia at the tip."""
        structure.tip_inertia += inertia
