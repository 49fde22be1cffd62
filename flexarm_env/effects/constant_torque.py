"""A torque that always acts: an amplifier offset, a preloaded cable, a slope."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect, torque_size
from flexarm_env.plant.structure import Structure


class ConstantTorque(Effect):
    """A torque that always acts: an amplifier offset, a preloaded cable, a slope."""

    name = "constant_torque"
    equation = "τ = τ₀"
    parameters: ClassVar = {"torque": torque_size("torque on the hub", 0.05, low=-1e4)}
    looks_like = "the arm moves further one way than the other, and rests under an offset; missing torque is a constant"
    confused_with = ("asymmetric_coulomb", "cable_stiffness", "base_tilt")
    pairs_with_all = True

    @staticmethod
    def structure(structure: Structure, torque: float) -> None:
        """Add to the constant torque on the hub."""
        structure.hub_torque += torque
