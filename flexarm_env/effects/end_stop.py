"""Stops of rubber or metal that end the arm's travel."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class EndStop(Effect):
    """Stops of rubber or metal that end the arm's travel."""

    name = "end_stop"
    equation = "τ = −k (θ − θ_s + T ω) beyond θ_s on either side, never pulling"
    parameters: ClassVar = {
        "stiffness": Parameter("N*m/rad", 0.0, 1e7, 20.0, null=0.0, meaning="k, of the stops"),
        "upper": Parameter("rad", -1e4, 1e4, 0.8, meaning="θ_s, angle of contact at the upper end", of_travel=True),
        "lower": Parameter("rad", -1e4, 1e4, -0.8, meaning="θ_s at the lower end", of_travel=True),
        "damping_time": Parameter("s", 0.0, 0.1, 2e-3, meaning="T, damping of the stops over k"),
    }
    looks_like = "the angle never passes a value, and the arm bounces back from it"
    confused_with = ("cable_stiffness", "saturation")
    source = "Hunt and Crossley, J. Appl. Mech. 42 (1975) 440, with linear stiffness"

    @staticmethod
    def torque(angle, speed, stiffness, upper, lower, damping_time):
        """Push back into the range."""
        if angle > upper:
            return -max(stiffness * (angle - upper + damping_time * speed), 0.0)
        if angle < lower:
            return max(stiffness * (lower - angle - damping_time * speed), 0.0)
        return 0.0

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Narrow and wide ranges."""
        return [{"stiffness": 20.0, "upper": place, "lower": -place, "damping_time": 2e-3} for place in (0.3, 0.6, 1.2)]
