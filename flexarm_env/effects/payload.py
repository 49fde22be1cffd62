"""A mass at the tip."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class Payload(Effect):
    """A mass at the tip."""

    name = "payload"
    equation = "M(tip, tip) += m"
    parameters: ClassVar = {"mass": Parameter("kg", 0.0, 1e3, 0.1, null=0.0, meaning="m, at the tip")}
    looks_like = "all frequencies lie low and swings are larger and longer"
    confused_with = ("tip_inertia", "root_compliance")
    source = "thesis eqs. 3.14 and 3.32"
    needs = ("tip",)
    condition = "payload"

    @staticmethod
    def structure(structure: Structure, mass: float) -> None:
        """Add to the mass at the tip."""
        structure.payload += mass
