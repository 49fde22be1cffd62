"""Stick and slip: the decision whether a body at rest sticks, and the change of mode."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Numbers, Places, Segment
from flexarm_env.plant.forces import angle_of, evaluate_forces
from flexarm_env.plant.friction import Contact, friction_budget, gear_load, preslides, presliding_friction
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.propagate import dot


@njit
def has_friction(d: Numbers, n: Places, body: int) -> bool:
    """Whether a body has dry friction at all; without it a body never sticks, and zero speed is no event."""
    return d[at.HUB_FRICTION_SHARE + body] > 0.0


@njit
def applied_offset(
    d: Numbers, n: Places, s: Numbers, body: int, command: float, w: Numbers, coefficients: int, order: int
) -> float:
    """Compute a coefficient (of 1, t, t²/2) of the torque on a body at rest, without the part in its row on z."""
    here = record(n, int(s[at.MODE]))
    total = 0.0
    if order == 0:
        row = here + n[at.HOLD_DRIVERS] + body * n[at.DRIVERS]
        total = d[row + at.W_COMMAND] * command + d[row + at.W_ONE] + d[row + at.W_SIDE] * s[at.GEAR_SIDE]
        total += d[row + at.W_HELD_HUB] * s[at.HELD_HUB] + d[row + at.W_HELD_MOTOR] * s[at.HELD_MOTOR]
    count = n[at.BODIES] + n[at.POINTS]
    row = here + n[at.HOLD_FORCES] + body * count
    return total + dot(d, row, w, coefficients + order * count, count)


@njit
def load_now(d: Numbers, n: Places, s: Numbers, mode: int) -> float:
    """Compute the present torque [Nm, arm side] in the gears, as far as laws depend on it."""
    if not n[at.VARYING] or (n[at.BODIES] == 1 and n[at.DRIVE_FEEDBACK] == at.NO_FEEDBACK):
        return gear_load(d, n, s, mode, 0.0, 0.0, 0.0, 0.0)
    here, size = record(n, mode), 2 * n[at.BLOCKS]
    z = Segment(s, at.Z_START)
    if n[at.BODIES] == 1:
        speed = dot(d, here + n[at.SPEED], s, at.Z_START, size)
        return gear_load(d, n, s, mode, 0.0, 0.0, angle_of(d, n, s, mode, 0, z), speed)
    motor = angle_of(d, n, s, mode, 1, z)
    windup = motor - angle_of(d, n, s, mode, 0, z)
    rate = dot(d, here + n[at.SPEED] + size, s, at.Z_START, size) - dot(d, here + n[at.SPEED], s, at.Z_START, size)
    return gear_load(d, n, s, mode, windup, rate, motor, 0.0)


@njit
def static_budget(d: Numbers, n: Places, s: Numbers, body: int, direction: float, angle: float, load: float) -> float:
    """Compute the static friction [Nm] against a push in `direction` on a body at rest at an angle."""
    at_rest = friction_budget(d, n, body, Contact(direction, 0.0, angle, s[at.TIME], load, True))
    # with static friction below sliding friction, a body that breaks away would be driven by its own friction
    return max(at_rest, friction_budget(d, n, body, Contact(direction, 0.0, angle, s[at.TIME], load, False)))


@njit
def remember_friction(d: Numbers, n: Places, s: Numbers) -> None:
    """Store the present angle and friction of a hub that preslides."""
    mode = int(s[at.MODE])
    if not preslides(n, 0) or is_stuck(mode, 0):
        return
    size, direction = 2 * n[at.BLOCKS], s[at.HUB_DIRECTION]
    angle = angle_of(d, n, s, mode, 0, Segment(s, at.Z_START))
    speed = dot(d, record(n, mode) + n[at.SPEED], s, at.Z_START, size)
    load = load_now(d, n, s, mode)
    dry = friction_budget(d, n, 0, Contact(direction, max(speed * direction, 0.0), angle, s[at.TIME], load, False))
    friction = presliding_friction(d, n, s, angle, dry)
    s[at.KNOWN_ANGLE], s[at.KNOWN_FRICTION] = angle, friction


@njit
def to_physical(d: Numbers, n: Places, s: Numbers, mode: int, w: Numbers, out: int) -> None:
    """Write [q, q̇, extra] to w at `out`."""
    here, size = record(n, mode), 2 * n[at.BLOCKS]
    for i in range(n[at.STATES]):
        w[out + i] = dot(d, here + n[at.PHYSICAL] + i * size, s, at.Z_START, size)
    for body in range(n[at.BODIES]):
        if is_stuck(mode, body):
            w[out + body] = s[at.HELD_HUB + body]
            w[out + n[at.COORDINATES] + body] = 0.0


@njit
def enter_mode(d: Numbers, n: Places, s: Numbers, mode: int, w: Numbers, physical: int) -> None:
    """Switch to a mode from the physical state in w at `physical`."""
    s[at.MODE] = mode
    here = record(n, mode)
    for body in range(n[at.BODIES]):
        s[at.HELD_HUB + body] = w[physical + body] if is_stuck(mode, body) else 0.0
    for i in range(2 * n[at.BLOCKS]):
        s[at.Z_START + i] = dot(d, here + n[at.MODAL] + i * n[at.STATES], w, physical, n[at.STATES])


@njit(forceinline=True)
def decide_stick_or_slip(a: Arrays, body: int, command: float, physical: int, coefficients: int) -> None:
    """Decide whether a body at zero speed sticks or turns (thesis section 2.2).

    The torque needed to hold it is compared with the budget of static friction.
    """
    d, n, s, w = a.d, a.n, a.s, a.w
    mode, bit = int(s[at.MODE]), 1 << body
    evaluate_forces(a, mode, mode | bit, coefficients)
    push = dot(d, record(n, mode) + n[at.HOLD] + body * 2 * n[at.BLOCKS], s, at.Z_START, 2 * n[at.BLOCKS])
    push += applied_offset(d, n, s, body, command, w, coefficients, 0)
    if preslides(n, body):
        s[at.HUB_DIRECTION] = 1.0 if push >= s[at.KNOWN_FRICTION] else -1.0
        return
    direction = 1.0 if push >= 0.0 else -1.0
    angle = angle_of(d, n, s, mode, body, Segment(s, at.Z_START))
    turns = abs(push) > static_budget(d, n, s, body, direction, angle, load_now(d, n, s, mode)) or not has_friction(d, n, body)
    if turns:
        s[at.HUB_DIRECTION + body] = direction
    if turns == is_stuck(mode, body):
        to_physical(d, n, s, mode, w, physical)
        w[physical + n[at.COORDINATES] + body] = 0.0
        enter_mode(d, n, s, mode ^ bit, w, physical)
