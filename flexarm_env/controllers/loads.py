"""Compensation of the modelled arm's static loads, common to all control laws: springs, torques, weight, a dead zone."""

from __future__ import annotations

import cmath
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.linear import share_of_payload
from flexarm_env.machine import weight

Floats = NDArray[np.float64]

#: Share of a dead zone's width up to which its compensation grows in proportion to the command, so that noise about 0 does
#: not make the command jump across the zone.
EDGE = 0.25


@dataclass(frozen=True)
class Weight:
    """The weight of an arm.

    Attributes:
        torque: largest one about the axis without payload [Nm].
        uphill: angle at which the arm balances upright [rad].
        share: torque with the payload over that without.
    """

    torque: float
    uphill: float
    share: float

    @classmethod
    def of(cls, arm: Arm) -> Weight:
        """Sum the weight that the constants give and that of a tilted base."""
        tilt = dict(arm.present()).get("base_tilt", {"torque": 0.0, "uphill": 0.0})
        parts = (weight(arm.constants), (tilt["torque"], tilt["uphill"]))
        total = sum(cmath.rect(torque, uphill) for torque, uphill in parts)
        if not total:
            return cls(0.0, 0.0, 1.0)
        return cls(abs(total), cmath.phase(total), 1.0 + share_of_payload(arm))

    def about_axis(self, angle: Floats) -> Floats:
        """Compute the torque with the payload (count,) [Nm] on a straight arm at hub angles (count,) [rad]."""
        return self.share * self.torque * np.sin(angle - self.uphill)


class KnownLoads:
    """Compensates known loads at the target, and a known dead zone.

    Args:
        arm: modelled, with a weight, or `cable_stiffness`, `constant_torque`, `base_tilt`, `payload` or `dead_zone` among its
            effects, or none of them.
    """

    def __init__(self, arm: Arm) -> None:
        structure = arm.structure()
        self.per_command = torque = structure.torque_by_command
        self.stiffness, self.torque = structure.hub_stiffness / torque, structure.hub_torque / torque
        self.weight = Weight.of(arm)
        self.dead_zone = float(dict(arm.present()).get("dead_zone", {}).get("width", 0.0))

    def compensated(self, command: Floats, target: Floats) -> Floats:
        """Add the compensation to a law's commands (count,) [A or V] at targets (count,) [rad]."""
        command = command + self.steady(target)
        if self.dead_zone > 0.0:
            command = command + self.dead_zone * np.clip(command / (EDGE * self.dead_zone), -1.0, 1.0)
        return command

    def steady(self, target: Floats) -> Floats:
        """Compute the commands (count,) [A or V] that hold arms at targets (count,) [rad] against their loads."""
        return self.stiffness * target - self.torque - self.weight.about_axis(target) / self.per_command

    def behind_dead_zone(self, command: Floats) -> Floats:
        """Compute the commands (count,) behind the dead zone."""
        if self.dead_zone > 0.0:
            return command - np.clip(command, -self.dead_zone, self.dead_zone)
        return command
