"""Dry friction that does not depend on speed."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class Coulomb(Effect):
    """Dry friction that does not depend on speed."""

    name = "coulomb"
    equation = "T = T_c sgn ω"
    parameters: ClassVar = {"torque": Parameter("N*m", 0.0, 1e4, 0.1, null=0.0, spread=0.5, meaning="sliding friction, arm side")}
    looks_like = "the hub stops within a finite time and then sits still against a torque; missing torque is a step at zero speed"
    confused_with = ("stiction", "constant_torque", "asymmetric_coulomb", "position_friction")
    source = "thesis section 2.2 and Table A.1"
    motor_share = "motor_coulomb_share"

    @staticmethod
    def friction(torque):
        """T_c."""
        return torque
