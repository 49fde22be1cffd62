"""Dry friction: its torque against motion or a push, and the load of the gears on which it depends."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.laws import factor_law, friction_law, presliding_law, spring_law
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
    """Compute friction [Nm] against motion in a direction, or at rest against a push: the sum over the effects.

    Factors, such as that of warming up, are of the dry part alone. Neither part drives: a lubricant may take away the linear
    friction, which is not among these effects, but no more.
    """
    factor = 1.0
    place = n[at.FACTOR_LAWS]
    for j in range(n[place]):
        factor *= factor_law(n[place + 1 + 2 * j], c.angle, c.time, d, n[place + 2 + 2 * j])
    dry, lubricated = 0.0, 0.0
    place = n[at.FRICTION_LAWS]
    for j in range(n[place]):
        law = n[place + 2 + 2 * j]
        share = d[law - 2 + body]
        if share > 0.0:
            kind = n[place + 1 + 2 * j]
            part = share * friction_law(kind, c.direction, c.speed, c.angle, c.time, c.load, c.at_rest, d, law)
            if d[law - 3] > 0.0:
                dry += part
            else:
                lubricated += part
    return max(factor * dry, 0.0) + max(lubricated, -d[at.HUB_VISCOUS + body] * c.speed)


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
def spring_torque(d: Numbers, n: Places, mode: int, windup: float, motor_angle: float) -> float:
    """Sum the torque [Nm] of the effects in gears that touch, or in a joint; all is arm side, the motor's angle [rad] as well."""
    total = 0.0
    place = n[at.SPRING_LAWS]
    for j in range(n[place] if n[at.BODIES] == 2 and mode < GEAR_OPEN else 0):
        turned = d[at.GEAR_RATIO] * motor_angle
        total += spring_law(n[place + 1 + 2 * j], windup, turned, d[at.LOAD_STIFFNESS], d, n[place + 2 + 2 * j])
    return total


@njit
def drive_voltage(d: Numbers, command: float, angle: float, speed: float) -> float:
    """Compute the voltage [V] for which the drive's law asks, from the motor's angle [rad] and speed [rad/s], arm side."""
    return d[at.VOLTAGE_BY_COMMAND] * command - d[at.VOLTAGE_BY_ANGLE] * angle - d[at.VOLTAGE_BY_SPEED] * speed


@njit
def limited_torque(d: Numbers, n: Places, command: float, angle: float, speed: float) -> float:
    """Compute what limits and a sagging supply add to the drive's torque [Nm, arm side]."""
    if n[at.DRIVE_FEEDBACK] != at.LIMITED:
        return 0.0
    asked, opposed = drive_voltage(d, command, angle, speed), d[at.BACK_EMF] * speed
    voltage, drop, largest = asked, d[at.LARGEST_DROP], d[at.LARGEST_VOLTAGE]
    voltage = min(max(voltage, opposed - drop), opposed + drop)
    voltage = min(max(voltage, -largest), largest)
    duty = voltage / d[at.SUPPLY_VOLTAGE]
    return d[at.TORQUE_BY_VOLTAGE] * ((voltage - opposed) / (1.0 + duty * duty * d[at.SUPPLY_SHARE]) - (asked - opposed))


@njit
def drive_torque(d: Numbers, n: Places, command: float, angle: float, speed: float) -> float:
    """Compute the torque [Nm, arm side] of a drive with feedback."""
    asked = drive_voltage(d, command, angle, speed) - d[at.BACK_EMF] * speed
    return d[at.TORQUE_BY_VOLTAGE] * asked + limited_torque(d, n, command, angle, speed)


@njit
def gear_load(d: Numbers, n: Places, s: Numbers, mode: int, windup: float, rate: float, angle: float, speed: float) -> float:
    """Compute the torque [Nm, arm side] in the gears; in rigid ones, the drive's at the angle [rad] and speed [rad/s]."""
    if n[at.BODIES] == 1:
        if n[at.DRIVE_FEEDBACK] != at.NO_FEEDBACK:
            return drive_torque(d, n, s[at.COMMAND], angle, speed)
        return d[at.LOAD_BY_COMMAND] * s[at.COMMAND]
    if mode >= GEAR_OPEN:
        return 0.0
    load = d[at.LOAD_STIFFNESS] * (windup - 0.5 * s[at.GEAR_SIDE] * d[at.GAP]) + d[at.LOAD_DAMPING] * rate
    if n[n[at.SPRING_LAWS]] > 0:
        load += spring_torque(d, n, mode, windup, angle)
    return load
