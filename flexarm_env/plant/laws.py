"""The laws of an arm without effects: what the kernel calls where no effect is active.

`compose` puts a switch over the effects' own functions in the place of these. Parameters of
effect `kind` start at d[k].
"""

from __future__ import annotations

from numba import njit


@njit
def friction_law(kind, direction, speed, angle, time, load, at_rest, d, k):
    """Budget of dry friction [Nm] that effect `kind` adds."""
    return 0.0


@njit
def factor_law(kind, angle, time, d, k):
    """Factor of effect `kind` on all dry friction."""
    return 1.0


@njit
def presliding_law(kind, before, travel, level, d, k):
    """Friction [Nm] after some travel that effect `kind` makes of that before and of the dry friction to which it tends."""
    return level


@njit
def torque_law(kind, angle, speed, time, d, k):
    """Torque on the hub [Nm] from effect `kind`."""
    return 0.0


@njit
def weight_law(kind, angle, d, k):
    """Torque about the hub [Nm] of a force in proportion to mass on beam and payload from effect `kind`."""
    return 0.0


@njit
def drag_law(kind, velocity, d, k):
    """Force per length on the beam [N/m] from effect `kind`."""
    return 0.0


@njit
def drive_law(kind, command, previous, interval, d, k):
    """Command that effect `kind` lets through, from the one given and the one before."""
    return command


@njit
def ramp_law(kind, command, previous, start, end, d, k):
    """Mean command over a part of a sample while effect `kind` takes it from the one before to this one."""
    return command


@njit
def sensor_law(kind, reading, angle, motor_angle, time, d, k):
    """Reading that effect `kind` makes of one without it."""
    return reading
