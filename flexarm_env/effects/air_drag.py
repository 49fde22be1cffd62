"""Drag of the air on the moving beam, with the square of the speed."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class AirDrag(Effect):
    """Drag of the air on the moving beam, with the square of the speed."""

    name = "air_drag"
    equation = "f = −c |v| v per length"
    parameters: ClassVar = {
        "coefficient": Parameter("N*s**2/m**3", 0.0, 1e3, 0.2, null=0.0, meaning="c, drag per length and speed squared")
    }
    looks_like = "missing torque grows with the square of the speed; large swings ring down faster than small ones"
    confused_with = ("viscous", "asymmetric_viscous", "beam_damping")
    source = "Baker, Woolam, Young, Int. J. Mech. Sci. 9 (1967) 743"
    needs = ("beam",)

    @staticmethod
    def drag(velocity, coefficient):
        """−c |v| v."""
        return -coefficient * abs(velocity) * velocity
