"""The laws of an arm without effects.

`compose` puts a switch over the effects' own functions in the place of these. Parameters of
effect `kind` start at d[k].
"""

from __future__ import annotations

from numba import njit


@njit
def friction_law(kind, direction, speed, angle, time, load, at_rest, d, k):
    """Compute the part of effect `kind` in the budget of dry friction [Nm]."""
    return 0.0


@njit
def factor_law(kind, angle, time, d, k):
    """Compute the factor of effect `kind` on all dry friction."""
    return 1.0


@njit
def presliding_law(kind, before, travel, level, d, k):
    """Compute the friction [Nm] of effect `kind` after some travel, from its value before and the level to which it tends."""
    return level


@njit
def torque_law(kind, angle, speed, time, d, k):
    """Compute the torque on the hub [Nm] of effect `kind`."""
    return 0.0


@njit
def weight_law(kind, angle, d, k):
    """Compute the torque about the hub [Nm] of effect `kind`'s force in proportion to mass on beam and payload."""
    return 0.0


@njit
def drag_law(kind, velocity, d, k):
    """Compute the force per length on the beam [N/m] of effect `kind`."""
    return 0.0


@njit
def drive_law(kind, command, previous, interval, d, k):
    """Compute the output of effect `kind` of the drive for a command and the one before."""
    return command


@njit
def ramp_law(kind, command, previous, start, end, d, k):
    """Compute the mean output over a part of a sample while effect `kind` ramps from the previous command to this one."""
    return command


@njit
def spring_law(kind, windup, motor_angle, stiffness, d, k):
    """Compute the torque [Nm, arm side] of effect `kind` that turns the hub and turns back the motor, through gears or joint."""
    return 0.0


@njit
def sensor_law(kind, reading, angle, motor_angle, time, d, k):
    """Compute the reading with effect `kind`, from the one without it."""
    return reading
