"""Parts of a model, each drawn at random to fit the size of its axis."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from benchmarks.machines.model import FIRST, Rng, log_uniform

Table = dict[str, Any]
#: Supplies [V].
SUPPLIES = (6.0, 12.0, 24.0, 48.0)


@dataclass(frozen=True)
class Size:
    """Largest torque [Nm], inertia [kg m²], amplitude of motion [rad], and circular frequency of the control loop [rad/s]."""

    torque: float
    inertia: float
    angle: float
    bandwidth: float

    def slowed(self, most: float) -> Size:
        """Limit the frequency of the control loop; the inertia grows so that the torque still fits the motion."""
        slow = min(self.bandwidth, most)
        return replace(self, bandwidth=slow, inertia=self.inertia * (self.bandwidth / slow) ** 2)


def axis(draw: Rng) -> Size:
    """Draw the size of an axis: three decades of torque, with inertia and motion that this torque can drive."""
    torque, angle = log_uniform(draw, 0.01, 10.0), float(draw.uniform(0.3, 1.2))
    bandwidth = 2.0 * math.pi * log_uniform(draw, 0.4, 1.2)
    return Size(torque, torque / (draw.uniform(2.0, 6.0) * bandwidth**2 * angle), angle, bandwidth)


def current(draw: Rng, size: Size, gear_ratio: float | None = None) -> Table:
    """Draw a drive that sets a current."""
    ratio = log_uniform(draw, 1.2, 100.0) if gear_ratio is None else gear_ratio
    limit = round(log_uniform(draw, 0.5, 10.0), 2)
    drive = {"input": "current", "gear_ratio": ratio, "limit": limit, "torque_constant": size.torque / (ratio * limit)}
    return drive | {"sure": draw.random() < 0.3}


def torque(size: Size) -> Table:
    """Build a drive that sets a torque."""
    return {"input": "current", "gear_ratio": 1.0, "limit": size.torque, "torque_constant": 1.0, "sure": True}


def voltage(draw: Rng, size: Size) -> Table:
    """Draw a drive that sets a voltage; its motor runs at two to five times the usual speed without load."""
    ratio, supply = log_uniform(draw, 5.0, 100.0), float(draw.choice(SUPPLIES))
    constant = supply / (ratio * draw.uniform(2.0, 5.0) * size.angle * size.bandwidth)
    drive = {"input": "voltage", "gear_ratio": ratio, "limit": supply, "torque_constant": float(constant)}
    return drive | {"resistance": float(ratio * constant * supply / size.torque), "sure": draw.random() < 0.3}


def inertias(draw: Rng, total: float, gear_ratio: float, bare: bool) -> tuple[float, float]:
    """Split an inertia [kg m²] between motor (motor side) and hub; a bare hub holds all of it."""
    share = 0.0 if bare else float(draw.uniform(0.15, 0.6))
    return share * total / gear_ratio**2, (1.0 - share) * total


def friction(draw: Rng, size: Size) -> Table:
    """Draw the effects of friction in the model, of which two of five have none."""
    if draw.random() < 0.4:
        return {}
    coulomb = float(draw.uniform(0.02, 0.1)) * size.torque
    viscous = float(draw.uniform(0.02, 0.15)) * size.torque / (size.angle * size.bandwidth)
    effects: Table = {"viscous": {"coefficient": viscous}, "coulomb": {"torque": coulomb}}
    return effects | ({"stiction": {"extra": float(draw.uniform(0.1, 0.4)) * coulomb}} if draw.random() < 0.4 else {})


def encoder(draw: Rng, turn: float = 2.0 * math.pi) -> Table:
    """Draw an encoder of 2000 to 16384 counts to a turn, with or without noise beside its steps."""
    step = turn / round(log_uniform(draw, 2000, 16384))
    return {"resolution": step, "noise": float(draw.choice([0.0, 0.3])) * step}


def tachometer(draw: Rng, size: Size, gear_ratio: float) -> Table:
    """Draw a tachometer with noise of up to two percent of the usual speed."""
    return {"motor_speed": {"noise": float(draw.uniform(0.003, 0.02)) * size.angle * size.bandwidth * gear_ratio}}


def beam(draw: Rng, inertia: float, frequency: float) -> tuple[Table, float]:
    """Draw a beam of an inertia about the hub [kg m²] and a first clamped frequency [Hz], and the time of its damping [s]."""
    length = log_uniform(draw, 0.3, 1.2)
    mass, circular = 3.0 * inertia / length**3, 2.0 * math.pi * frequency
    stiffness = mass * (circular * length**2 / FIRST) ** 2
    table = {"elements": int(draw.integers(2, 5)), "length": length, "mass_per_length": mass, "bending_stiffness": stiffness}
    return table, 2.0 * float(draw.uniform(0.002, 0.01)) / circular


def root_moment(size: Size, made: Mapping[str, float]) -> float:
    """Estimate the usual bending moment at the root of a beam [Nm]: that which half of the largest torque asks of it."""
    return 0.5 * size.torque * made["mass_per_length"] * made["length"] ** 3 / 3.0 / size.inertia


def gages(draw: Rng, size: Size, made: Mapping[str, float]) -> Table:
    """Draw a strain gage at the root, and one at the middle in every other arm, with an output of about 3 V."""
    gain, noise = 3.0 / root_moment(size, made), float(draw.uniform(0.003, 0.02))
    places = {"strain_base": draw.uniform(0.02, 0.1)} | ({"strain_mid": draw.uniform(0.4, 0.6)} if draw.random() < 0.5 else {})
    length = made["length"]
    return {name: {"gain": gain, "position": float(x) * length, "noise": noise} for name, x in places.items()}


def tip(draw: Rng, size: Size, made: Mapping[str, float]) -> Table:
    """Draw a sensor of the tip's deflection, with noise of up to one percent of the usual one."""
    usual = root_moment(size, made) * made["length"] ** 2 / (3.0 * made["bending_stiffness"])
    return {"tip_deflection": {"noise": float(draw.uniform(0.002, 0.01)) * usual}}
