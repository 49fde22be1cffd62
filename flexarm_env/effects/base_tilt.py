"""Gravity on an arm with a tilted axis."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

from flexarm_env.effects.base import Effect, torque_size
from flexarm_env.parameters import Parameter


class BaseTilt(Effect):
    """Gravity on an arm with a tilted axis: it turns the hub, and bends the beam by its weight and the payload's."""

    name = "base_tilt"
    equation = "τ = g sin(θ − θ₀)"
    parameters: ClassVar = {
        "torque": torque_size("g, largest torque of gravity about the hub, without payload", 0.05),
        "uphill": Parameter("rad", -6.3, 6.3, 0.0, meaning="θ₀, where the arm points uphill and balances"),
    }
    looks_like = "missing torque is one period of a sine over a full turn of the arm"
    confused_with = ("cable_stiffness", "constant_torque")
    scan_phase = "uphill"

    @staticmethod
    def weight(angle, torque, uphill):
        """G sin(θ − θ₀)."""
        return torque * math.sin(angle - uphill)

    @classmethod
    def cycles_per_turn(cls, values: Mapping[str, float]) -> float:
        """One: gravity."""
        return 1.0

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Two directions of the slope, of which every other is a sum."""
        return [{"torque": 0.05, "uphill": uphill} for uphill in (0.0, 1.57)]
