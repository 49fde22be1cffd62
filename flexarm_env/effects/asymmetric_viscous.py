"""Viscous friction that differs between the two directions."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class AsymmetricViscous(Effect):
    """Viscous friction that differs between the two directions."""

    name = "asymmetric_viscous"
    equation = "T = ±a |ω|: a more while ω > 0, a less while ω < 0"
    parameters: ClassVar = {
        "coefficient": Parameter("N*m*s", -1e5, 1e5, 0.03, null=0.0, meaning="half the difference of the two coefficients")
    }
    modifies = "viscous"
    looks_like = "missing torque grows with speed, to the same side for both directions"
    confused_with = ("asymmetric_coulomb", "constant_torque")
    source = "Janot, Gautier, Brunot, EMPS, Workshop on Nonlinear System Identification Benchmarks (2019)"
    varies = True

    @staticmethod
    def friction(direction, speed, coefficient):
        """±a |ω| by direction."""
        return direction * coefficient * speed
