"""A step without events of any arm without drag: two bodies, gears, and forces that vary with the motion."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.propagate import dot
from flexarm_env.plant.slide_force import fit_force, variation
from flexarm_env.plant.slide_table import ORDER, PER_BLOCK, tested_row
from flexarm_env.plant.stick_slip import (
    GEAR_OPEN,
    apply_laws,
    is_stuck,
    load_now,
    preslides,
    record,
    remember,
    rubs,
    static_budget,
)

#: Speed [rad/s] below which it does not matter to friction that yields when it turns round.
QUIET = 1e-4


@njit
def keeps(
    d: Numbers, n: Places, s: Numbers, mode: int, body: int, before: float, after: float, bend: float, moves: bool,
    tab: Numbers, bends: int, w: Numbers, inputs: int, changes: int,
) -> bool:  # fmt: skip
    """Whether a body surely goes on turning or being held over the step."""
    if not rubs(d, n, body):
        return True
    if preslides(n, body) and max(abs(before), abs(after)) + bend < QUIET:
        return True
    bodies = n[at.BODIES]
    here, stuck = record(n, mode), is_stuck(mode, body)
    for other in range(bodies if moves else 0):
        turned = variation(w, changes + other * ORDER)
        bend += tab[bends + body * bodies + other] * turned
        if stuck:
            bend += abs(d[here + n[at.HOLD_FORCES] + body * bodies + other]) * turned
    if not stuck:
        return min(before * s[at.HUB_DIRECTION + body], after * s[at.HUB_DIRECTION + body]) > bend
    offset = dot(d, here + n[at.HOLD_DRIVERS] + body * n[at.DRIVERS], w, inputs, n[at.DRIVERS])
    angle, load = s[at.HELD_HUB + body], load_now(d, n, s, mode)
    high, low = static_budget(d, n, s, body, 1.0, angle, load), static_budget(d, n, s, body, -1.0, angle, load)
    return max(before, after) + offset + bend < high and min(before, after) + offset - bend > -low


@njit
def slide(
    d: Numbers, n: Places, s: Numbers, command: float, length: float, last: bool, tab: Numbers, first: int, w: Numbers,
) -> bool:  # fmt: skip
    """Move the arm on by a step with a table and return True, if it is sure that no event falls in it.

    `last` says that the step cannot be halved.
    """
    mode = int(s[at.MODE])
    here, blocks, bodies, drivers = record(n, mode), n[at.BLOCKS], n[at.BODIES], n[at.DRIVERS]
    size, quantities = 2 * blocks, 2 * bodies
    inputs = size  # in w, after the new state
    start = inputs + drivers
    forces = start + quantities
    changes = forces + bodies
    varying = n[at.VARYING] > 0
    if mode >= GEAR_OPEN:
        return False
    for body in range(bodies if varying else 0):
        w[start + body] = dot(d, here + n[at.ANGLE] + body * size, s, at.HEADER, size)
        w[start + body] += d[here + n[at.HOLDS_ANGLE] + body] * s[at.HELD_HUB + body]
        w[start + bodies + body] = dot(d, here + n[at.SPEED] + body * size, s, at.HEADER, size)
        turns = rubs(d, n, body) and not is_stuck(mode, body)
        if turns and w[start + bodies + body] * s[at.HUB_DIRECTION + body] <= (-QUIET if preslides(n, body) else 0.0):
            return False
    if not varying:
        for i in range(quantities):
            w[start + i] = 0.0
    apply_laws(d, n, s, mode, s[at.TIME], w, start, forces)
    hub_force, motor_force = w[forces], w[forces + 1] if bodies == 2 else 0.0
    side, held_hub, held_motor, coupled = s[at.GEAR_SIDE], s[at.HELD_HUB], s[at.HELD_MOTOR], n[at.COUPLED] > 0
    w[inputs + at.W_COMMAND], w[inputs + at.W_ONE], w[inputs + at.W_SIDE] = command, 1.0, side
    w[inputs + at.W_HUB], w[inputs + at.W_MOTOR] = hub_force, motor_force
    w[inputs + at.W_HELD_HUB], w[inputs + at.W_HELD_MOTOR] = held_hub, held_motor
    moves = varying and (mode != (1 << bodies) - 1 or n[n[at.TORQUE_LAWS]] > 0)
    bends = first + PER_BLOCK * blocks
    rows = bends + (bodies + 1) * bodies + 7
    if moves and not (fit_force(d, n, s, mode, length, last, tab, rows, w, inputs, start, changes) or last):
        return False
    ends = rows + ORDER * quantities * (size + drivers + ORDER * bodies)
    hub, hub_weight = tested_row(n, mode, 0)
    motor, motor_weight = tested_row(n, mode, bodies - 1)
    mesh, mesh_weight = tested_row(n, mode, bodies)
    hub_before, hub_after, hub_bend = 0.0, 0.0, 0.0
    motor_before, motor_after, motor_bend = 0.0, 0.0, 0.0
    mesh_before, mesh_after, mesh_bend = 0.0, 0.0, 0.0
    for k in range(blocks):
        i = here + n[at.FORCING] + 2 * k * drivers
        f1 = d[i + at.W_COMMAND] * command + d[i + at.W_HUB] * hub_force + d[i + at.W_ONE]
        if coupled:
            f1 += d[i + at.W_MOTOR] * motor_force + d[i + at.W_SIDE] * side
            f1 += d[i + at.W_HELD_HUB] * held_hub + d[i + at.W_HELD_MOTOR] * held_motor
        i += drivers
        f2 = d[i + at.W_COMMAND] * command + d[i + at.W_HUB] * hub_force + d[i + at.W_ONE]
        if coupled:
            f2 += d[i + at.W_MOTOR] * motor_force + d[i + at.W_SIDE] * side
            f2 += d[i + at.W_HELD_HUB] * held_hub + d[i + at.W_HELD_MOTOR] * held_motor
        a, b = d[here + n[at.C0] + k], d[here + n[at.C1] + k]
        i = first + PER_BLOCK * k
        c, r, r0 = tab[i], tab[i + 1], tab[i + 2]
        p, q = s[at.HEADER + 2 * k], s[at.HEADER + 2 * k + 1]
        x, y = q + f1, f2 - a * p - b * q
        new_p = p + (r + b * r0) * x + r0 * y
        new_q = c * x + r * y - f1
        if moves:
            j = ends + 2 * k * bodies * ORDER
            for order in range(bodies * ORDER):
                new_p += tab[j + 2 * order] * w[changes + order]
                new_q += tab[j + 2 * order + 1] * w[changes + order]
        w[2 * k], w[2 * k + 1] = new_p, new_q
        bend = tab[i + 3] * math.sqrt(a * x * x + y * y)
        hub_before += d[hub + 2 * k] * p + d[hub + 2 * k + 1] * q
        hub_after += d[hub + 2 * k] * new_p + d[hub + 2 * k + 1] * new_q
        hub_bend += d[hub_weight + k] * bend
        if bodies == 2:
            motor_before += d[motor + 2 * k] * p + d[motor + 2 * k + 1] * q
            motor_after += d[motor + 2 * k] * new_p + d[motor + 2 * k + 1] * new_q
            motor_bend += d[motor_weight + k] * bend
        if d[at.GAP] > 0.0:
            mesh_before += d[mesh + 2 * k] * p + d[mesh + 2 * k + 1] * q
            mesh_after += d[mesh + 2 * k] * new_p + d[mesh + 2 * k + 1] * new_q
            mesh_bend += d[mesh_weight + k] * bend
    if not keeps(d, n, s, mode, 0, hub_before, hub_after, hub_bend, moves, tab, bends, w, inputs, changes):
        return False
    if bodies == 2 and not keeps(d, n, s, mode, 1, motor_before, motor_after, motor_bend, moves, tab, bends, w, inputs, changes):
        return False
    if d[at.GAP] > 0.0:
        held = held_motor - held_hub  # held angles of free bodies are 0
        for body in range(bodies if moves else 0):
            mesh_bend += tab[bends + 2 * bodies + body] * variation(w, changes + body * ORDER)
        if min(side * (mesh_before + held), side * (mesh_after + held)) - 0.5 * d[at.GAP] <= mesh_bend:
            return False
    for i in range(size):
        s[at.HEADER + i] = w[i]
    s[at.TIME] += length
    remember(d, n, s)
    return True
