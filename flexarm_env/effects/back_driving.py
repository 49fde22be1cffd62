"""Friction of the gears that differs when the arm drives the motor."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class BackDriving(Effect):
    """Friction of the gears that differs when the arm drives the motor, as that of worm and cycloidal gears does."""

    name = "back_driving"
    equation = "T = d |T_gears| while T_gears ω < 0"
    parameters: ClassVar = {
        "coefficient": Parameter("", -0.95, 0.95, 0.1, null=0.0, meaning="d, beside the share that is lost in both directions"),
    }
    modifies = "load_friction"
    looks_like = "a share of the torque is lost, but another one while the arm brakes than while it is driven"
    confused_with = ("load_friction", "coulomb", "asymmetric_coulomb")
    source = "Wang and Kim, J. Mech. Robot. 7 (2015) 011003: efficiency of gears by the direction of power"
    varies = True

    @staticmethod
    def friction(load, direction, coefficient):
        """D times the load of the gears against the motion."""
        return coefficient * abs(load) if load * direction < 0.0 else 0.0

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """More and less friction."""
        return [{"coefficient": sign * 0.1} for sign in (1.0, -1.0)]
