"""Friction that falls from rest to a low speed, as a lubricating film builds up."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect, torque_size
from flexarm_env.parameters import Parameter


class Stribeck(Effect):
    """Friction that falls from rest to a low speed, as a lubricating film builds up."""

    name = "stribeck"
    equation = "T = extra · exp(−(ω/v)²)"
    parameters: ClassVar = {
        "extra": torque_size("friction at rest above that at speed, arm side", 0.1),
        "falloff_speed": Parameter("rad/s", 1e-6, 20.0, 0.2, meaning="speed v over which it falls"),
    }
    modifies = "coulomb"
    looks_like = "missing torque is a bump around zero speed; stick-slip at creeping speed"
    confused_with = ("stiction", "coulomb")
    source = "Armstrong-Hélouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083"
    varies = True

    @staticmethod
    def friction(speed, extra, falloff_speed):
        """Extra · exp(−(ω/v)²)."""
        return extra * math.exp(-((speed / falloff_speed) ** 2))
