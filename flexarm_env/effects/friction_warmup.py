"""Friction that falls while the bearings and the grease warm up."""

from __future__ import annotations

import math
from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class FrictionWarmup(Effect):
    """Friction that falls while the bearings and the grease warm up."""

    name = "friction_warmup"
    equation = "T = T_dry (1 − w (1 − exp(−t/τ)))"
    parameters: ClassVar = {
        "share": Parameter("", -2.0, 0.95, 0.2, null=0.0, meaning="w, share of dry friction that is lost in the end"),
        "time_constant": Parameter("s", 0.1, 1e4, 5.0, meaning="τ, of warming up"),
    }
    modifies = "coulomb"
    looks_like = "the arm stops later in the course of a recording"
    confused_with = ("coulomb",)
    source = "Bittencourt and Gunnarsson, J. Dyn. Syst. Meas. Control 134 (2012) 051013"

    @staticmethod
    def factor(time, share, time_constant):
        """1 − w (1 − exp(−t/τ))."""
        return 1.0 + share * math.expm1(-time / time_constant)
