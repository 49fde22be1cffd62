"""Dry friction that changes periodically with the angle, as with a bent shaft or a worn gear."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect, torque_size
from flexarm_env.parameters import Parameter


class PositionFriction(Effect):
    """Dry friction that changes periodically with the angle, as with a bent shaft or a worn gear."""

    name = "position_friction"
    equation = "T = a sin(nθ + φ)"
    parameters: ClassVar = {
        "amplitude": torque_size("size of the change, arm side", 0.05),
        "cycles": Parameter("1/rad", 0.05, 5e3, 3.0, meaning="n, cycles of the sine per radian times 2π"),
        "phase": Parameter("rad", -6.3, 6.3, 0.0, meaning="φ, at angle zero"),
    }
    modifies = "coulomb"
    looks_like = "missing torque opposes motion and repeats with the angle, with opposite sign for the two directions"
    confused_with = ("cogging", "coulomb")
    scan_phase = "phase"
    source = "Armstrong, Control of Machines with Friction (1991), chapter 3"
    varies = True

    @staticmethod
    def friction(angle, amplitude, cycles, phase):
        """A sin(nθ + φ)."""
        return amplitude * math.sin(cycles * angle + phase)

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Grid of cycle numbers, with two phases: the error has a local minimum at each."""
        return [
            {"amplitude": 0.05, "cycles": cycles, "phase": phase}
            for cycles in (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0)
            for phase in (0.0, 1.57)
        ]
