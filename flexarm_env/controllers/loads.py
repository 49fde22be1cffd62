"""What the believed arm asks of its drive at rest, whatever the control law: springs, constant torques, a dead zone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm

Floats = NDArray[np.float64]

#: Share of a dead zone's width below which a wanted command grows into it evenly, so that noise about 0 is not thrown across.
EDGE = 0.25


class KnownLoads:
    """Adds to commands what holds the hub at its target against known loads, and what crosses a known dead zone.

    Args:
        arm: believed, with `cable_stiffness`, `constant_torque` or `dead_zone` among its effects, or none of them.
    """

    def __init__(self, arm: Arm) -> None:
        structure = arm.structure()
        torque = structure.torque_by_command
        self.stiffness, self.torque = structure.hub_stiffness / torque, structure.hub_torque / torque
        self.dead_zone = float(dict(arm.present()).get("dead_zone", {}).get("width", 0.0))

    def met(self, command: Floats, target: Floats) -> Floats:
        """Return the commands (count,) [A or V] to send, for those that a law wants and its targets (count,) [rad]."""
        command = command + (self.stiffness * target - self.torque)
        if self.dead_zone > 0.0:
            command = command + self.dead_zone * np.clip(command / (EDGE * self.dead_zone), -1.0, 1.0)
        return command

    def through(self, command: Floats) -> Floats:
        """Return what of the commands (count,) gets through the dead zone."""
        if self.dead_zone > 0.0:
            return command - np.clip(command, -self.dead_zone, self.dead_zone)
        return command
