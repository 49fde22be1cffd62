"""Dry friction that differs between the two directions."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect, torque_size


class AsymmetricCoulomb(Effect):
    """Dry friction that differs between the two directions."""

    name = "asymmetric_coulomb"
    equation = "T = ±a: a more while ω > 0, a less while ω < 0; static friction stays"
    parameters: ClassVar = {"torque": torque_size("half the difference of the two frictions, arm side", 0.05, low=-1e4)}
    modifies = "coulomb"
    looks_like = "the arm stops sooner one way than the other; missing torque is the same constant while it moves either way"
    confused_with = ("constant_torque", "base_tilt")
    source = "Swevers et al., IEEE Trans. Robotics and Automation 13 (1997) 730"

    @staticmethod
    def friction(direction, at_rest, torque):
        """±a by direction while sliding."""
        if at_rest:
            return 0.0
        return direction * torque
