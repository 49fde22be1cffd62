"""Scales of a machine, by which the ranges of its effects follow its size."""

from __future__ import annotations

import math
from collections.abc import Callable

from benchmarks.machines.model import Model

PHASE = (-math.pi, math.pi)


def of_torque(share: float) -> Callable[[Model], float]:
    """Build the function that computes a share of the largest torque."""
    return lambda m: share * m.torque


def coulomb(m: Model) -> float:
    return m.values.get("effects.coulomb.torque", 0.0)


def viscous(m: Model) -> float:
    return m.values.get("effects.viscous.coefficient", 0.0)


def limit(m: Model) -> float:
    return m.values["drive.limit"]


def beam(m: Model, key: str) -> float:
    return m.values[f"beam.{key}"]


def mass(m: Model) -> float:
    return beam(m, "mass_per_length") * beam(m, "length")


def root(m: Model) -> float:
    return 0.4 * beam(m, "length") / beam(m, "bending_stiffness")


def motor_side(m: Model) -> float:
    return m.values["drive.gear_ratio"] ** 2 * m.values["drive.motor_inertia"]


def strain(m: Model) -> float:
    return 3.0  # V, usual output: see parts.gages


def tip(m: Model) -> float:
    return 100.0 * m.values["sensors.tip_deflection.noise"]


def rotary(m: Model) -> bool:
    return m.rotary


def one_body(m: Model) -> bool:
    return m.values["drive.gear_stiffness"] == 0.0


def motor_cycles(m: Model, low: float, high: float) -> tuple[float, float]:
    """Convert cycles per radian of the arm times 2π to those of the motor."""
    return low / m.values["drive.gear_ratio"], high / m.values["drive.gear_ratio"]


def friction_cycles(m: Model) -> dict[str, tuple[float, float]]:
    low = max(1.6 / m.angle, 1.0)
    return {"posn": (low, max(4.0 * low, 4.0)), "posphi": PHASE}
