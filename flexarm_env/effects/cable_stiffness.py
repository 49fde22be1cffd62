"""A cable or hose that pulls the hub towards the angle at which it hangs free."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class CableStiffness(Effect):
    """A cable or hose that pulls the hub towards the angle at which it hangs free."""

    name = "cable_stiffness"
    equation = "τ = −k (θ − θ₀)"
    parameters: ClassVar = {
        "stiffness": Parameter("N*m/rad", 0.0, 1e5, 0.05, null=0.0, meaning="k"),
        "rest_angle": Parameter("rad", -6.3, 6.3, 0.0, meaning="θ₀, where it does not pull, within a turn", of_travel=True),
    }
    looks_like = "missing torque falls along a straight line with the angle"
    confused_with = ("constant_torque", "base_tilt")

    @staticmethod
    def structure(structure: Structure, stiffness: float, rest_angle: float) -> None:
        """Add a spring between the hub and the fixed frame."""
        structure.hub_stiffness += stiffness
        structure.hub_torque += stiffness * rest_angle
