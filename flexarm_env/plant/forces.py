"""The forces of the laws: friction and torque on the bodies, drag along the beam, weight."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Numbers, Places, Segment
from flexarm_env.plant.friction import (
    Contact,
    friction_budget,
    gear_load,
    limited_torque,
    preslides,
    presliding_friction,
    spring_torque,
)
from flexarm_env.plant.laws import drag_law, torque_law, weight_law
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.propagate import dot


@njit(forceinline=True)
def effect_torque(d: Numbers, n: Places, body: int, angle: float, speed: float, time: float) -> float:
    """Sum the non-linear torque [Nm] of the effects, which acts on the hub."""
    total = 0.0
    place = n[at.TORQUE_LAWS]
    for j in range(n[place] if body == 0 else 0):
        total += torque_law(n[place + 1 + 2 * j], angle, speed, time, d, n[place + 2 + 2 * j])
    return total


@njit
def angle_of(d: Numbers, n: Places, s: Numbers, mode: int, body: int, z: Segment) -> float:
    """Compute the arm-side angle [rad] of hub or motor."""
    here = record(n, mode)
    free = dot(d, here + n[at.ANGLE] + body * 2 * n[at.BLOCKS], z.data, z.first, 2 * n[at.BLOCKS])
    return free + d[here + n[at.HOLDS_ANGLE] + body] * s[at.HELD_HUB + body]


@njit
def read_motion(a: Arrays, mode: int, z: Segment, out: int) -> None:
    """Write the arguments of the laws to w at `out`: the bodies' angles, their speeds, velocities at points of the beam."""
    d, n, w = a.d, a.n, a.w
    here, size, bodies = record(n, mode), 2 * n[at.BLOCKS], n[at.BODIES]
    for body in range(bodies):
        w[out + body] = angle_of(d, n, a.s, mode, body, z)
        w[out + bodies + body] = dot(d, here + n[at.SPEED] + body * size, z.data, z.first, size)
    for point in range(n[at.POINTS]):
        w[out + 2 * bodies + point] = dot(d, here + n[at.DRAG_VELOCITY] + point * size, z.data, z.first, size)


@njit(forceinline=True)
def apply_laws(a: Arrays, mode: int, time: float, motion: int, out: int) -> None:
    """Write the torque of friction and effects on each body, the drag at each point of the beam and its weight to w at `out`."""
    d, n, s, w = a.d, a.n, a.s, a.w
    bodies = n[at.BODIES]
    last = bodies - 1
    windup, rate = w[motion + last] - w[motion], w[motion + bodies + last] - w[motion + bodies]
    load = gear_load(d, n, s, mode, windup, rate, w[motion + last], w[motion + bodies + last])
    for body in range(bodies):
        angle, speed = w[motion + body], w[motion + bodies + body]
        if is_stuck(mode, body):
            w[out + body] = effect_torque(d, n, body, angle, 0.0, time)
            continue
        direction = s[at.HUB_DIRECTION + body]
        dry = friction_budget(d, n, body, Contact(direction, max(speed * direction, 0.0), angle, time, load, False))
        against = presliding_friction(d, n, s, angle, dry) if preslides(n, body) else direction * dry
        w[out + body] = effect_torque(d, n, body, angle, speed, time) - against
    if n[n[at.SPRING_LAWS]] > 0 and bodies == 2:
        through = spring_torque(d, n, mode, windup, w[motion + 1])
        w[out] += through
        w[out + 1] -= through
    if n[at.DRIVE_FEEDBACK] == at.LIMITED:
        speed = 0.0 if is_stuck(mode, last) else w[motion + bodies + last]
        w[out + last] += limited_torque(d, n, s[at.COMMAND], w[motion + last], speed)
    place = n[at.DRAG_LAWS]
    for point in range(n[at.POINTS]):
        total = 0.0
        for j in range(n[place]):
            total += drag_law(n[place + 1 + 2 * j], w[motion + 2 * bodies + point], d, n[place + 2 + 2 * j])
        w[out + bodies + point] = total
    place = n[at.WEIGHT_LAWS]  # the last point is no place on the beam but the column of weight, so drag there is overwritten
    if n[place] > 0:
        total = 0.0
        for j in range(n[place]):
            total += weight_law(n[place + 1 + 2 * j], w[motion], d, n[place + 2 + 2 * j])
        w[out + bodies + n[at.POINTS] - 1] = total


@njit(forceinline=True)
def evaluate_forces(a: Arrays, mode: int, held: int, out: int) -> None:
    """Write the present forces of the laws to w at `out`, with the bodies of mode `held` held; uses room for twice as many."""
    n, s, w = a.n, a.s, a.w
    motion = out + n[at.BODIES] + n[at.POINTS]
    if n[at.VARYING]:
        read_motion(a, mode, Segment(s, at.Z_START), motion)
    else:  # no law depends on the motion
        for i in range(2 * n[at.BODIES]):
            w[motion + i] = 0.0
    apply_laws(a, held, s[at.TIME], motion, out)
