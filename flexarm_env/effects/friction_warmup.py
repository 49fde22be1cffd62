"""Friction that falls while the bearings and the grease warm up."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect, torque_size
from flexarm_env.parameters import Parameter


class FrictionWarmup(Effect):
    """Friction that falls while the bearings and the grease warm up."""

    name = "friction_warmup"
    equation = "T = −w (1 − exp(−t/τ))"
    parameters: ClassVar = {
        "drop": torque_size("how much dry friction is lost in the end", 0.05),
        "time_constant": Parameter("s", 0.1, 1e4, 5.0, meaning="τ, of warming up"),
    }
    modifies = "coulomb"
    looks_like = "the arm stops later in the course of a recording"
    confused_with = ("coulomb",)
    source = "Bittencourt and Gunnarsson, J. Dyn. Syst. Meas. Control 134 (2012) 051013"
    varies = True

    @staticmethod
    def friction(time, drop, time_constant):
        """−w (1 − exp(−t/τ))."""
        return drop * math.expm1(-time / time_constant)
