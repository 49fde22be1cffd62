"""Friction that grows with the torque that the gears carry."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class LoadFriction(Effect):
    """Friction that grows with the torque that the gears carry."""

    name = "load_friction"
    equation = "T = c |T_gears|"
    parameters: ClassVar = {"coefficient": Parameter("", 0.0, 0.95, 0.1, null=0.0, meaning="c, of the torque in the gears")}
    modifies = "coulomb"
    looks_like = "a share of the torque is lost: accelerating and braking both fall short"
    confused_with = ("coulomb", "viscous")
    source = "Bittencourt and Gunnarsson, J. Dyn. Syst. Meas. Control 134 (2012) 051013"
    varies = True

    @staticmethod
    def friction(load, coefficient):
        """Multiply the load of the gears by c."""
        return coefficient * abs(load)
