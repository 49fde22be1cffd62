"""Drive and gains of the thesis's rig, from which commands, gains and ranges are scaled to other arms."""

from __future__ import annotations

import math

from flexarm_env.arm import Arm

#: Largest current of the drive [A] (thesis section 4.2) and gear ratio (Table A.1).
LIMIT, GEAR_RATIO = 5.0, 1.5
#: PD gains on the arm's angle [A/rad] and on the motor's speed [A s/rad] (thesis section 2.3, Fig. 2.6).
PROPORTIONAL, DERIVATIVE = 2.5308, 0.6625
#: What is like 1 A of it for a drive without a limit: the torque on the arm [Nm] (Table A.1), and a tenth of a half turn [rad].
TORQUE, ANGLE = 0.495, math.pi / 10


def command_scale(arm: Arm) -> float:
    """Compute the factor from a command for the thesis's arm [A] to the like command for this one [A, V, Nm or rad]."""
    drive = arm.constants["drive"]
    if drive["limit"] > 0.0:
        return drive["limit"] / LIMIT
    return {"voltage": drive["resistance"], "torque": TORQUE, "position": ANGLE}.get(arm.input, 1.0)
