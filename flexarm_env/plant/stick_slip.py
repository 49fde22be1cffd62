"""Dry friction: its torque while a body turns, and the decision whether a body at rest sticks."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Numbers, Places, Segment
from flexarm_env.plant.laws import drag_law, factor_law, friction_law, presliding_law, torque_law, weight_law
from flexarm_env.plant.propagate import dot

#: Bit of a mode with open gears, the highest one.
GEAR_OPEN = 4


@njit
def record(n: Places, mode: int) -> int:
    """Return the place in d of a mode's record."""
    return n[at.MODES] + mode * n[at.STRIDE]


@njit
def is_stuck(mode: int, body: int) -> bool:
    """Whether the mode holds the body (0 hub, 1 motor)."""
    return (mode >> body) & 1 == 1


class Contact(NamedTuple):
    """Arguments of dry friction: direction (±1), speed along it [rad/s], angle [rad], time [s], load [Nm], whether at rest."""

    direction: float
    speed: float
    angle: float
    time: float
    load: float
    at_rest: bool


@njit
def friction_budget(d: Numbers, n: Places, body: int, c: Contact) -> float:
    """Return dry friction [Nm] against motion in a direction, or at rest against a push: the sum over the effects."""
    total = 0.0
    place = n[at.FRICTION_LAWS]
    for j in range(n[place]):
        law = n[place + 2 + 2 * j]
        share = d[law - 2 + body]
        if share > 0.0:
            kind = n[place + 1 + 2 * j]
            total += share * friction_law(kind, c.direction, c.speed, c.angle, c.time, c.load, c.at_rest, d, law)
    place = n[at.FACTOR_LAWS]
    for j in range(n[place]):
        total *= factor_law(n[place + 1 + 2 * j], c.angle, c.time, d, n[place + 2 + 2 * j])
    return max(total, 0.0)


@njit
def preslides(n: Places, body: int) -> bool:
    """Whether a body's friction yields before it slides, so that the body never sticks."""
    return body == 0 and n[n[at.PRESLIDING_LAWS]] > 0


@njit
def presliding_friction(d: Numbers, n: Places, s: Numbers, angle: float, level: float) -> float:
    """Return the presliding friction [Nm] of the hub against motion to positive angles, from its last known value."""
    place = n[at.PRESLIDING_LAWS]
    return presliding_law(n[place + 1], s[at.KNOWN_FRICTION], angle - s[at.KNOWN_ANGLE], level, d, n[place + 2])


@njit
def gear_load(d: Numbers, n: Places, s: Numbers, mode: int, windup: float, rate: float) -> float:
    """Return the torque [Nm, arm side] in the gears; in rigid ones, the drive's."""
    if n[at.BODIES] == 1:
        return d[at.LOAD_BY_COMMAND] * s[at.COMMAND]
    if mode >= GEAR_OPEN:
        return 0.0
    return d[at.LOAD_STIFFNESS] * (windup - 0.5 * s[at.GEAR_SIDE] * d[at.GAP]) + d[at.LOAD_DAMPING] * rate


@njit(forceinline=True)
def effect_torque(d: Numbers, n: Places, body: int, angle: float, speed: float, time: float) -> float:
    """Return the non-linear torque [Nm] of the effects, which acts on the hub."""
    total = 0.0
    place = n[at.TORQUE_LAWS]
    for j in range(n[place] if body == 0 else 0):
        total += torque_law(n[place + 1 + 2 * j], angle, speed, time, d, n[place + 2 + 2 * j])
    return total


@njit
def angle_of(d: Numbers, n: Places, s: Numbers, mode: int, body: int, z: Segment) -> float:
    """Return the arm-side angle [rad] of hub or motor."""
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
    load = gear_load(d, n, s, mode, w[motion + last] - w[motion], w[motion + bodies + last] - w[motion + bodies])
    for body in range(bodies):
        angle, speed = w[motion + body], w[motion + bodies + body]
        if is_stuck(mode, body):
            w[out + body] = effect_torque(d, n, body, angle, 0.0, time)
            continue
        direction = s[at.HUB_DIRECTION + body]
        dry = friction_budget(d, n, body, Contact(direction, max(speed * direction, 0.0), angle, time, load, False))
        against = presliding_friction(d, n, s, angle, dry) if preslides(n, body) else direction * dry
        w[out + body] = effect_torque(d, n, body, angle, speed, time) - against
    place = n[at.DRAG_LAWS]
    for point in range(n[at.POINTS]):
        total = 0.0
        for j in range(n[place]):
            total += drag_law(n[place + 1 + 2 * j], w[motion + 2 * bodies + point], d, n[place + 2 + 2 * j])
        w[out + bodies + point] = total
    place = n[at.WEIGHT_LAWS]
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
        read_motion(a, mode, Segment(s, at.HEADER), motion)
    else:  # no law depends on the motion
        for i in range(2 * n[at.BODIES]):
            w[motion + i] = 0.0
    apply_laws(a, held, s[at.TIME], motion, out)


@njit
def has_friction(d: Numbers, n: Places, body: int) -> bool:
    """Whether a body has dry friction at all; without it a body never sticks, and zero speed is no event."""
    return d[at.HUB_RUBS + body] > 0.0


@njit
def applied_offset(
    d: Numbers, n: Places, s: Numbers, body: int, command: float, w: Numbers, coefficients: int, order: int
) -> float:
    """Return a coefficient (of 1, t, t²/2) of the torque on a body at rest, without the part in its row on z."""
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
    """Return the present torque [Nm, arm side] in the gears, as far as laws depend on it."""
    if not n[at.VARYING] or n[at.BODIES] == 1:
        return gear_load(d, n, s, mode, 0.0, 0.0)
    here, size = record(n, mode), 2 * n[at.BLOCKS]
    z = Segment(s, at.HEADER)
    windup = angle_of(d, n, s, mode, 1, z) - angle_of(d, n, s, mode, 0, z)
    rate = dot(d, here + n[at.SPEED] + size, s, at.HEADER, size) - dot(d, here + n[at.SPEED], s, at.HEADER, size)
    return gear_load(d, n, s, mode, windup, rate)


@njit
def static_budget(d: Numbers, n: Places, s: Numbers, body: int, direction: float, angle: float, load: float) -> float:
    """Return the static friction [Nm] against a push in `direction` on a body at rest at an angle."""
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
    angle = angle_of(d, n, s, mode, 0, Segment(s, at.HEADER))
    speed = dot(d, record(n, mode) + n[at.SPEED], s, at.HEADER, size)
    load = load_now(d, n, s, mode)
    dry = friction_budget(d, n, 0, Contact(direction, max(speed * direction, 0.0), angle, s[at.TIME], load, False))
    friction = presliding_friction(d, n, s, angle, dry)
    s[at.KNOWN_ANGLE], s[at.KNOWN_FRICTION] = angle, friction


@njit
def to_physical(d: Numbers, n: Places, s: Numbers, mode: int, w: Numbers, out: int) -> None:
    """Write [q, q̇, extra] to w at `out`."""
    here, size = record(n, mode), 2 * n[at.BLOCKS]
    for i in range(n[at.STATES]):
        w[out + i] = dot(d, here + n[at.PHYSICAL] + i * size, s, at.HEADER, size)
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
        s[at.HEADER + i] = dot(d, here + n[at.MODAL] + i * n[at.STATES], w, physical, n[at.STATES])


@njit(forceinline=True)
def decide_stick_or_slip(a: Arrays, body: int, command: float, physical: int, coefficients: int) -> None:
    """Decide whether a body at zero speed sticks or turns (thesis section 2.2).

    The torque needed to hold it is compared with the budget of static friction.
    """
    d, n, s, w = a.d, a.n, a.s, a.w
    mode, bit = int(s[at.MODE]), 1 << body
    evaluate_forces(a, mode, mode | bit, coefficients)
    push = dot(d, record(n, mode) + n[at.HOLD] + body * 2 * n[at.BLOCKS], s, at.HEADER, 2 * n[at.BLOCKS])
    push += applied_offset(d, n, s, body, command, w, coefficients, 0)
    if preslides(n, body):
        s[at.HUB_DIRECTION] = 1.0 if push >= s[at.KNOWN_FRICTION] else -1.0
        return
    direction = 1.0 if push >= 0.0 else -1.0
    angle = angle_of(d, n, s, mode, body, Segment(s, at.HEADER))
    turns = abs(push) > static_budget(d, n, s, body, direction, angle, load_now(d, n, s, mode)) or not has_friction(d, n, body)
    if turns:
        s[at.HUB_DIRECTION + body] = direction
    if turns == is_stuck(mode, body):
        to_physical(d, n, s, mode, w, physical)
        w[physical + n[at.COORDINATES] + body] = 0.0
        enter_mode(d, n, s, mode ^ bit, w, physical)
