"""Dry friction: its torque against motion or a push, and the load of the gears on which it depends."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.laws import factor_law, friction_law, presliding_law
from flexarm_env.plant.modes import GEAR_OPEN


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
    """Compute dry friction [Nm] against motion in a direction, or at rest against a push: the sum over the effects."""
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
    """Compute the presliding friction [Nm] of the hub against motion to positive angles, from its last known value."""
    place = n[at.PRESLIDING_LAWS]
    return presliding_law(n[place + 1], s[at.KNOWN_FRICTION], angle - s[at.KNOWN_ANGLE], level, d, n[place + 2])


@njit
def gear_load(d: Numbers, n: Places, s: Numbers, mode: int, windup: float, rate: float) -> float:
    """Compute the torque [Nm, arm side] in the gears; in rigid ones, the drive's."""
    if n[at.BODIES] == 1:
        return d[at.LOAD_BY_COMMAND] * s[at.COMMAND]
    if mode >= GEAR_OPEN:
        return 0.0
    return d[at.LOAD_STIFFNESS] * (windup - 0.5 * s[at.GEAR_SIDE] * d[at.GAP]) + d[at.LOAD_DAMPING] * rate
