"""A stop of rubber or metal that ends the arm's travel on one side."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class EndStop(Effect):
    """A stop of rubber or metal that ends the arm's travel on one side."""

    name = "end_stop"
    equation = "τ = −k (θ − θ_s + T ω) beyond θ_s, never pulling"
    parameters: ClassVar = {
        "stiffness": Parameter("N*m/rad", 0.0, 1e6, 20.0, null=0.0, meaning="k, of the stop"),
        "place": Parameter("rad", -12.6, 12.6, 1.0, meaning="θ_s, angle of contact; its sign is the side that is closed"),
        "damping_time": Parameter("s", 0.0, 0.1, 2e-3, meaning="T, damping of the stop over k"),
    }
    looks_like = "the angle never passes a value, and the arm bounces back from it"
    confused_with = ("cable_stiffness", "saturation")
    source = "Hunt and Crossley, J. Appl. Mech. 42 (1975) 440, with linear stiffness"

    @staticmethod
    def torque(angle, speed, stiffness, place, damping_time):
        """Push back towards the free side."""
        side = 1.0 if place >= 0.0 else -1.0
        depth = side * (angle - place)
        if depth <= 0.0:
            return 0.0
        return -side * max(stiffness * (depth + damping_time * side * speed), 0.0)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Stops near and far, on both sides."""
        places = (-1.6, -0.8, -0.4, 0.4, 0.8, 1.6)
        return [{"stiffness": 20.0, "place": place, "damping_time": 2e-3} for place in places]
