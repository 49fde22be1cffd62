"""Compensation of the modelled arm's static loads, common to all control laws: springs, constant torques, a dead zone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm

Floats = NDArray[np.float64]

#: Share of a dead zone's width up to which its compensation grows in proportion to the command, so that noise about 0 does
#: not make the command jump across the zone.
EDGE = 0.25


class KnownLoads:
    """Compensates known loads at the target, and a known dead zone.

    Args:
        arm: modelled, with `cable_stiffness`, `constant_torque` or `dead_zone` among its effects, or none of them.
    """

    def __init__(self, arm: Arm) -> None:
        structure = arm.structure()
        torque = structure.torque_by_command
        self.stiffness, self.torque = structure.hub_stiffness / torque, structure.hub_torque / torque
        self.dead_zone = float(dict(arm.present()).get("dead_zone", {}).get("width", 0.0))

    def compensated(self, command: Floats, target: Floats) -> Floats:
        """Add the compensation to a law's commands (count,) [A or V] at targets (count,) [rad]."""
        command = command + self.steady(target)
        if self.dead_zone > 0.0:
            command = command + self.dead_zone * np.clip(command / (EDGE * self.dead_zone), -1.0, 1.0)
        return command

    def steady(self, target: Floats) -> Floats:
        """Compute the commands (count,) [A or V] that hold arms at targets (count,) [rad] against their loads."""
        return self.stiffness * target - self.torque

    def behind_dead_zone(self, command: Floats) -> Floats:
        """Compute the commands (count,) behind the dead zone."""
        if self.dead_zone > 0.0:
            return command - np.clip(command, -self.dead_zone, self.dead_zone)
        return command
