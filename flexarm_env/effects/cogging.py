"""The pull of the motor's magnets on its teeth, periodic in the motor's angle."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect, torque_size
from flexarm_env.parameters import Parameter


class Cogging(Effect):
    """The pull of the motor's magnets on its teeth, periodic in the motor's angle."""

    name = "cogging"
    equation = "τ = a sin(nθ + φ)"
    parameters: ClassVar = {
        "amplitude": torque_size("size of the torque, arm side", 0.05),
        "cycles": Parameter("1/rad", 2.5, 5e3, 9.0, meaning="n, cycles per radian of the arm times 2π"),
        "phase": Parameter("rad", -6.3, 6.3, 0.0, meaning="φ, at angle zero"),
    }
    looks_like = "missing torque repeats with the angle, the same for both directions; rest angles bunch"
    confused_with = ("position_friction", "cable_stiffness")
    scan_phase = "phase"
    source = "Hanselman, Brushless Permanent Magnet Motor Design, chapter 7"

    @staticmethod
    def torque(angle, amplitude, cycles, phase):
        """A sin(nθ + φ)."""
        return amplitude * math.sin(cycles * angle + phase)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Grid of cycle numbers, with two phases: the error has a local minimum at each."""
        return [
            {"amplitude": 0.05, "cycles": cycles, "phase": phase}
            for cycles in (3.0, 4.5, 6.0, 7.5, 9.0, 10.5, 12.0, 15.0, 18.0, 21.0, 24.0, 30.0, 36.0)
            for phase in (0.0, 1.57)
        ]
