"""Voltage drop at the brushes, not compensated by an amplifier that sets the voltage for a current."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class BrushDrop(Effect):
    """Voltage drop at the brushes, not compensated by an amplifier that sets the voltage for a current.

    Under a voltage command the drop acts as Coulomb friction of N kφ V_b / R does.
    """

    name = "brush_drop"
    equation = "i = command ∓ V_b/R beyond ±V_b/R, else 0"
    parameters: ClassVar = {
        "drop": Parameter("V", 0.0, 100.0, 0.2, null=0.0, meaning="V_b, over both brushes", of_command=True),
        "resistance": Parameter("ohm", 1e-6, 1e6, 1.35, spread=0.0, meaning="R, of the armature", source="thesis App. A"),
    }
    looks_like = "small commands do nothing and large ones fall short by a constant"
    confused_with = ("dead_zone", "coulomb")
    needs = ("current",)
    source = "thesis App. A, experiment 1: kφ seems to fall with speed"

    @staticmethod
    def drive(command, drop, resistance):
        """Command ∓ V_b/R, or 0."""
        lost = drop / resistance
        if command > lost:
            return command - lost
        if command < -lost:
            return command + lost
        return 0.0
