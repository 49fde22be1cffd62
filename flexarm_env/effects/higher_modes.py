"""Modes of the beam that too few finite elements leave out."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class HigherModes(Effect):
    """Modes of the beam that too few finite elements leave out."""

    name = "higher_modes"
    equation = "more elements, the same beam"
    parameters: ClassVar = {
        "elements": Parameter("", 0, 16, 4, null=0, meaning="finite elements in place of those of the arm file", is_count=True)
    }
    looks_like = "strain and speed ring at frequencies that the model misplaces or lacks"
    confused_with = ("root_compliance", "tip_inertia", "gear_compliance")
    source = "thesis section 3.1; notes on the frequencies of one element"
    needs = ("beam",)
    fitted = False
    most_elements = 2

    @staticmethod
    def structure(structure: Structure, elements: float) -> None:
        """Divide the beam more finely."""
        structure.elements = max(structure.elements, int(elements))
