"""Compliance of what the machine stands on: it turns back as the arm turns."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class FixtureCompliance(Effect):
    """Compliance of what the machine stands on: it turns back as the arm turns, and sensors measure against it."""

    name = "fixture_compliance"
    equation = "J_f φ'' + k (φ + T φ') = −torque of the drive, arm turns by θ + φ"
    parameters: ClassVar = {
        "stiffness": Parameter("N*m/rad", 1e-6, math.inf, 300.0, null=math.inf, meaning="k, of table or stand"),
        "inertia": Parameter("kg*m**2", 1e-9, 1e4, 0.05, meaning="J_f, of all that turns with the stator"),
        "damping_time": Parameter("s", 1e-6, 1.0, 1e-3, meaning="T, damping over k"),
    }
    looks_like = "a vibration that the arm's own parts do not have, with the hub held as well"
    confused_with = ("gear_compliance", "root_compliance", "higher_modes")

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Resonances over a decade of frequency, of light and heavy stands: no slope leads from one to another."""
        own = super().starts()[0]
        softer, heavier = (1.0, 0.1, 0.01), (1.0, 10.0)
        return [{**own, "stiffness": k * own["stiffness"], "inertia": j * own["inertia"]} for k in softer for j in heavier]

    @staticmethod
    def structure(structure: Structure, stiffness: float, inertia: float, damping_time: float) -> None:
        """Put the stator on a damped spring."""
        structure.fixture_compliance, structure.fixture_inertia = 1.0 / stiffness, inertia
        structure.fixture_damping_time = damping_time
