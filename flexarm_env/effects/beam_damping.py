"""Damping of bending inside the beam (Kelvin and Voigt)."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class BeamDamping(Effect):
    """Damping of bending inside the beam (Kelvin and Voigt)."""

    name = "beam_damping"
    equation = "B = t_d K of the beam"
    parameters: ClassVar = {"time": Parameter("s", 0.0, 1.0, 0.002, null=0.0, meaning="t_d, ratio of damping to stiffness")}
    looks_like = "strain rings down faster than the model predicts, the more the higher the mode, also while the hub is stuck"
    confused_with = ("air_drag", "strain_lag")
    source = "thesis Figure 3.9; Clough and Penzien, Dynamics of Structures, section 17"
    needs = ("beam",)

    @staticmethod
    def structure(structure: Structure, time: float) -> None:
        """Add to the damping time of the beam."""
        structure.beam_damping += time
