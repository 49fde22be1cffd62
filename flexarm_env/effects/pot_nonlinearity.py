"""Nonlinearity of a potentiometer with an uneven track or mounted off the axis."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class PotNonlinearity(Effect):
    """Nonlinearity of a potentiometer with an uneven track or mounted off the axis."""

    name = "pot_nonlinearity"
    equation = "y = θ + a sin(nθ + φ)"
    parameters: ClassVar = {
        "amplitude": Parameter("rad", 0.0, 1.0, 0.02, null=0.0, meaning="a, largest error"),
        "cycles": Parameter("1/rad", 0.3, 5e3, 2.0, meaning="n, cycles per radian of the arm times 2π"),
        "phase": Parameter("rad", -6.3, 6.3, 0.0, meaning="φ, at angle zero"),
    }
    looks_like = "angle alone has an error that is periodic in the angle; speed and strain fit"
    confused_with = ("sensor_offset",)
    scan_phase = "phase"
    needs = ("arm_angle",)
    reads = ("arm_angle",)

    @staticmethod
    def sensor(reading, angle, amplitude, cycles, phase):
        """θ + a sin(nθ + φ)."""
        return reading + amplitude * math.sin(cycles * angle + phase)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Grid of cycle numbers, with two phases: the error has a local minimum at each."""
        return [
            {"amplitude": 0.02, "cycles": cycles, "phase": phase}
            for cycles in (1.0, 2.0, 3.0, 4.5, 6.0, 9.0, 12.0)
            for phase in (0.0, 1.57)
        ]
