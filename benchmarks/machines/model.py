"""A model of a machine as an arm file has it, and the sizes that its experiments and effects scale with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from flexarm_env import Arm

Rng = np.random.Generator


@dataclass(frozen=True)
class Model:
    """A model, as given to a diagnosis.

    Attributes:
        family: name in `families.FAMILIES`.
        table: of the arm file, numbers in SI units.
        torque: largest of the drive, arm side [Nm].
        inertia: all that the drive turns, arm side [kg m²].
        angle: amplitude of its motions [rad].
        bandwidth: circular frequency of its control loop [rad/s].
        rotary: whether its angle is one, and not the travel of a screw (1 m stands for 1 rad).
    """

    family: str
    table: Mapping[str, Any]
    torque: float
    inertia: float
    angle: float
    bandwidth: float
    rotary: bool = True

    @cached_property
    def arm(self) -> Arm:
        """The model as an arm."""
        return Arm.from_table(self.table, self.family)

    @cached_property
    def values(self) -> dict[str, float]:
        """Every number of the arm by its path."""
        arm = self.arm
        sections = {**arm.constants, **{f"sensors.{k}": v for k, v in arm.sensors.items()}}
        sections |= {f"effects.{k}": v for k, v in arm.effects.items()}
        return {f"{section}.{key}": float(value) for section, table in sections.items() for key, value in table.items()}

    @property
    def speed(self) -> float:
        """Usual speed of the hub [rad/s]."""
        return self.angle * self.bandwidth

    @property
    def torque_per_command(self) -> float:
        """Torque of the drive at rest, arm side [Nm/A or Nm/V]."""
        drive = self.arm.constants["drive"]
        amps = 1.0 / drive["resistance"] if self.arm.input == "voltage" else 1.0
        return drive["gear_ratio"] * drive["torque_constant"] * amps

    @property
    def clamped(self) -> float:
        """First circular frequency of the beam on a held hub [rad/s]; 0 for a rigid arm."""
        beam = self.arm.constants.get("beam")
        return clamped_frequency(**beam) if beam else 0.0


#: Root of cos(z) cosh(z) = -1, squared.
FIRST = 1.87510407**2


def clamped_frequency(length: float, mass_per_length: float, bending_stiffness: float, **others: float) -> float:
    """Compute the first circular frequency [rad/s] of a clamped beam."""
    return FIRST * float(np.sqrt(bending_stiffness / mass_per_length)) / length**2


def log_uniform(draw: Rng, low: float, high: float) -> float:
    """Draw a number that is uniform in its logarithm."""
    return float(np.exp(draw.uniform(np.log(low), np.log(high))))
