"""A step without events of any arm without drag: two bodies, gears, and forces that vary with the motion.

Where laws ask for angle or speed, the force over the step is the quartic in time through its values at five Lobatto
nodes of the motion that it causes: exponential collocation of order eight (Hochbruck and Ostermann, Exponential
integrators, Acta Numerica 2010, section 2.2). Laws ask for few quantities, so that its sweeps are few sums: tables
say how each quantity moves without the change of force, and by each of that change's coefficients.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from flexarm_env.plant.crossing import stray
from flexarm_env.plant.layout import (
    ANGLE,
    BLOCKS,
    BODIES,
    C0,
    C1,
    COUPLED,
    DRIVERS,
    FORCE_COLUMNS,
    FORCING,
    GAP,
    GEAR_SIDE,
    HEADER,
    HELD_HUB,
    HELD_MOTOR,
    HOLD,
    HOLD_DRIVERS,
    HOLD_FORCES,
    HOLD_WEIGHT,
    HOLDS_ANGLE,
    HUB_DIRECTION,
    MESH,
    MESH_WEIGHT,
    MODE,
    POINTS,
    REACH,
    SPEED,
    SPEED_WEIGHT,
    TIME,
    TORQUE_LAWS,
    VARYING,
    W_COMMAND,
    W_HELD_HUB,
    W_HELD_MOTOR,
    W_HUB,
    W_MOTOR,
    W_ONE,
    W_SIDE,
    Numbers,
    Places,
)
from flexarm_env.plant.propagate import INVERSE_FACTORIALS, LONG_REACH, dot, inlined_dot
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

#: Lobatto's nodes after the start, and the coefficients of u to u⁴ from the values at them of what is 0 at u = 0.
NODES = np.array([0.5 - math.sqrt(3.0 / 28.0), 0.5, 0.5 + math.sqrt(3.0 / 28.0), 1.0])
COEFFICIENTS = np.ascontiguousarray(np.linalg.inv(np.power.outer(NODES, np.arange(1, 5))))
ORDER = 4
#: A step is halved so often at most.
DEPTH = 3
#: Terms of the series of a short time; numbers of a block in a table: C, S, R₀, stray.
TERMS = 12
PER_BLOCK = 4
MOST_SWEEPS = 8
#: Over the force: what further sweeps may change, and the largest coefficient of the quartic part that a step may have.
SWEEP_TOLERANCE, QUARTIC_TOLERANCE = 1e-8, 2e-2
#: Sweeps that change the force by more than this share of what the one before did are given up, if the step can be halved.
SLOW = 0.3
#: Speed [rad/s] below which it does not matter to friction that yields when it turns round.
QUIET = 1e-4


@njit
def long_response(c0: float, c1: float, t: float, r: Numbers, at: int) -> None:
    """Write C, S, R₀ to R₄ of one block after time t [s] to r: as block_response does, for higher orders."""
    doublings = 0
    while abs(c0) * t * t + abs(c1) * t > LONG_REACH:
        t *= 0.5
        doublings += 1
    d0, d1 = c0 * t * t, c1 * t
    older, old, r3, r4 = 0.0, 1.0, INVERSE_FACTORIALS[5], INVERSE_FACTORIALS[6]
    for k in range(6, 5 + TERMS):
        older, old = old, -(d1 * old + d0 * older)
        r3 += old * INVERSE_FACTORIALS[k]
        r4 += old * INVERSE_FACTORIALS[k + 1]
    r2 = INVERSE_FACTORIALS[4] - d1 * r3 - d0 * r4
    r1 = INVERSE_FACTORIALS[3] - d1 * r2 - d0 * r3
    r0 = 0.5 - d1 * r1 - d0 * r2
    c, s = 1.0 - d0 * r0, t * (1.0 - d1 * r0 - d0 * r1)
    r0, r1, r2, r3, r4 = r0 * t**2, r1 * t**3, r2 * t**4, r3 * t**5, r4 * t**6
    for _ in range(doublings):
        r4 += c * r4 + s * r3 + t * (r3 + t / 2.0 * (r2 + t / 3.0 * (r1 + t / 4.0 * r0)))
        r3 += c * r3 + s * r2 + t * (r2 + t / 2.0 * (r1 + t / 3.0 * r0))
        r2 += c * r2 + s * r1 + t * (r1 + t / 2.0 * r0)
        r1 += c * r1 + s * r0 + t * r0
        r0 += c * r0 + s * s
        c, s = c * c - c0 * s * s, s * (2.0 * c - c1 * s)
        t *= 2.0
    r[at], r[at + 1], r[at + 2], r[at + 3], r[at + 4], r[at + 5], r[at + 6] = c, s, r0, r1, r2, r3, r4


@njit
def table_size(n: Places) -> int:
    """How many numbers the table of a step takes (see prepare_slide)."""
    blocks, bodies = n[BLOCKS], n[BODIES]
    size = PER_BLOCK * blocks + (bodies + 1) * bodies + 7
    if n[VARYING]:
        nodes = ORDER * 2 * bodies  # of each quantity
        size += nodes * (2 * blocks + n[DRIVERS] + ORDER * bodies) + 2 * ORDER * bodies * blocks
    return size


@njit
def slides(n: Places) -> bool:
    """Whether the arm has tables for slide: where a glide would not do, and no drag varies along the beam."""
    return n[POINTS] == 0 and (n[VARYING] > 0 or n[BODIES] == 2)


@njit
def slide_table(n: Places, mode: int, slot: int, level: int) -> int:
    """Where the table of a substep stands, halved so often (see glide.prepare)."""
    return record(n, mode) + n[REACH] + (slot * (DEPTH + 1 if n[VARYING] else 1) + level) * table_size(n)


@njit
def tested_row(n: Places, mode: int, row: int) -> tuple[int, int]:
    """Return the places of the row that tells of a body's event, or (last) of the gears', and of its weights."""
    here, blocks = record(n, mode), n[BLOCKS]
    if row == n[BODIES]:
        return here + n[MESH], here + n[MESH_WEIGHT]
    if is_stuck(mode, row):
        return here + n[HOLD] + row * 2 * blocks, here + n[HOLD_WEIGHT] + row * blocks
    return here + n[SPEED] + row * 2 * blocks, here + n[SPEED_WEIGHT] + row * blocks


@njit
def bend_by_force(d: Numbers, n: Places, mode: int, row: int, body: int, length: float) -> float:
    """How far a tested row strays from its chord, per variation of the force on a body."""
    here, blocks = record(n, mode), n[BLOCKS]
    place, weight = tested_row(n, mode, row)
    column = here + n[FORCE_COLUMNS] + body * 2 * blocks
    total = 0.0
    for k in range(blocks):
        a, b = d[here + n[C0] + k], d[here + n[C1] + k]
        f, g = abs(d[column + 2 * k]), abs(d[column + 2 * k + 1])
        growth = math.exp(max(-b, 0.0) * length)
        total += d[weight + k] * 0.125 * length * length * growth * (math.sqrt(a) * f + g)
        total += 0.125 * length * (abs(d[place + 2 * k]) * f + abs(d[place + 2 * k + 1]) * g)
    return total


@njit
def prepare_slide(d: Numbers, n: Places, mode: int, length: float, to: Numbers, at: int) -> None:
    """Write the table of a step of some length: per block C, S, R₀, stray; per tested row and body the bend by force.

    If forces vary, for each node and quantity (angles, then speeds): its row on z at the start, what each driver adds,
    what each coefficient of the force's change adds; then, by block, what these add to z in the end.
    """
    here, blocks, bodies, drivers = record(n, mode), n[BLOCKS], n[BODIES], n[DRIVERS]
    size, quantities = 2 * blocks, 2 * bodies
    bends = at + PER_BLOCK * blocks
    for row in range(bodies + 1):
        for body in range(bodies):
            to[bends + row * bodies + body] = bend_by_force(d, n, mode, row, body, length)
    response = bends + (bodies + 1) * bodies
    rows = response + 7
    drives = rows + ORDER * quantities * size
    shifts = drives + ORDER * quantities * drivers
    ends = shifts + ORDER * quantities * ORDER * bodies
    if n[VARYING]:
        for i in range(drives, ends):
            to[i] = 0.0
    for k in range(blocks):
        c0, c1 = d[here + n[C0] + k], d[here + n[C1] + k]
        forcing = here + n[FORCING] + 2 * k * drivers
        for node in range(0 if n[VARYING] else ORDER - 1, ORDER):
            long_response(c0, c1, NODES[node] * length, to, response)
            c, s = to[response], to[response + 1]
            for q in range(quantities if n[VARYING] else 0):
                place = n[ANGLE] + q * size if q < bodies else n[SPEED] + (q - bodies) * size
                place += here + 2 * k
                u, v = d[place], d[place + 1]
                if u == 0.0 and v == 0.0:
                    to[rows + (node * quantities + q) * size + 2 * k] = 0.0
                    to[rows + (node * quantities + q) * size + 2 * k + 1] = 0.0
                    continue
                to[rows + (node * quantities + q) * size + 2 * k] = u * c - v * c0 * s
                to[rows + (node * quantities + q) * size + 2 * k + 1] = u * s + v * (c - c1 * s)
                faster, slower = s, to[response + 2]
                by_first, by_second = u * (faster + c1 * slower) - v * c0 * slower, u * slower + v * faster
                for j in range(drivers):
                    f, g = d[forcing + j], d[forcing + drivers + j]
                    to[drives + (node * quantities + q) * drivers + j] += by_first * f + by_second * g
                scale = 1.0
                for order in range(ORDER):
                    scale *= (order + 1) / length
                    faster, slower = to[response + 2 + order], to[response + 3 + order]
                    by_first, by_second = u * (faster + c1 * slower) - v * c0 * slower, u * slower + v * faster
                    for body in range(bodies):
                        f, g = d[forcing + W_HUB + body], d[forcing + drivers + W_HUB + body]
                        i = shifts + ((node * quantities + q) * bodies + body) * ORDER + order
                        to[i] += scale * (by_first * f + by_second * g)
        i = at + PER_BLOCK * k
        to[i], to[i + 1], to[i + 2] = to[response], to[response + 1], to[response + 2]
        to[i + 3] = stray(c0, c1, length)
        for body in range(bodies if n[VARYING] else 0):
            f, g = d[forcing + W_HUB + body], d[forcing + drivers + W_HUB + body]
            scale = 1.0
            for order in range(ORDER):
                scale *= (order + 1) / length
                faster, slower = to[response + 2 + order], to[response + 3 + order]
                i = ends + 2 * ((k * bodies + body) * ORDER + order)
                to[i] = scale * (f * (faster + c1 * slower) + g * slower)
                to[i + 1] = scale * (g * faster - c0 * slower * f)


@njit
def fit_force(
    d: Numbers, n: Places, s: Numbers, mode: int, length: float, last: bool, tab: Numbers, rows: int, w: Numbers,
    inputs: int, start: int, changes: int,
) -> bool:  # fmt: skip
    """Find how the forces change over the step: coefficients of u to u⁴, by body, to w at `changes`.

    `inputs` are the drivers, `start` the motion and after it the forces at the start. Return whether the sweeps
    converge and the quartic is small.
    """
    blocks, bodies, drivers = n[BLOCKS], n[BODIES], n[DRIVERS]
    size, quantities = 2 * blocks, 2 * bodies
    here = record(n, mode)
    drives = rows + ORDER * quantities * size
    shifts = drives + ORDER * quantities * drivers
    forces = start + quantities
    motion = changes + ORDER * bodies
    new = motion + quantities
    values = new + bodies
    free = values + ORDER * bodies
    for i in range(ORDER * quantities):
        total = inlined_dot(tab, rows + i * size, s, HEADER, size)
        for j in range(drivers):
            total += tab[drives + i * drivers + j] * w[inputs + j]
        q = i % quantities
        if q < bodies:
            total += d[here + n[HOLDS_ANGLE] + q] * s[HELD_HUB + q]
        w[free + i] = total
    for i in range(ORDER * bodies):
        w[values + i] = w[changes + i] = 0.0
    scale = 0.0
    for body in range(bodies):
        scale += abs(w[forces + body])
    before = 1.0
    for sweep in range(MOST_SWEEPS):
        change = 0.0
        for node in range(ORDER):
            for q in range(quantities):
                i = node * quantities + q
                w[motion + q] = w[free + i] + dot(tab, shifts + i * bodies * ORDER, w, changes, bodies * ORDER)
            apply_laws(d, n, s, mode, s[TIME] + NODES[node] * length, w, motion, new)
            for body in range(bodies):
                value = w[new + body] - w[forces + body]
                change = max(change, abs(value - w[values + body * ORDER + node]))
                w[values + body * ORDER + node] = value
        for body in range(bodies):
            for order in range(ORDER):
                total = 0.0
                for node in range(ORDER):
                    total += COEFFICIENTS[order, node] * w[values + body * ORDER + node]
                w[changes + body * ORDER + order] = total
        if change * min(change / before, 1.0) <= SWEEP_TOLERANCE * scale:
            quartic = 0.0
            for body in range(bodies):
                quartic = max(quartic, abs(w[changes + body * ORDER + ORDER - 1]))
            return quartic <= QUARTIC_TOLERANCE * scale
        if sweep > 0 and change > SLOW * before and not last:
            return False
        before = change
    return False


@njit
def variation(w: Numbers, changes: int) -> float:
    """Bound of how much a force varies over the step."""
    total = 0.0
    for order in range(ORDER):
        total += (order + 1) * abs(w[changes + order])
    return total


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
    bodies = n[BODIES]
    here, stuck = record(n, mode), is_stuck(mode, body)
    for other in range(bodies if moves else 0):
        turned = variation(w, changes + other * ORDER)
        bend += tab[bends + body * bodies + other] * turned
        if stuck:
            bend += abs(d[here + n[HOLD_FORCES] + body * bodies + other]) * turned
    if not stuck:
        return min(before * s[HUB_DIRECTION + body], after * s[HUB_DIRECTION + body]) > bend
    offset = dot(d, here + n[HOLD_DRIVERS] + body * n[DRIVERS], w, inputs, n[DRIVERS])
    angle, load = s[HELD_HUB + body], load_now(d, n, s, mode)
    high, low = static_budget(d, n, s, body, 1.0, angle, load), static_budget(d, n, s, body, -1.0, angle, load)
    return max(before, after) + offset + bend < high and min(before, after) + offset - bend > -low


@njit
def slide(
    d: Numbers, n: Places, s: Numbers, command: float, length: float, last: bool, tab: Numbers, at: int, w: Numbers,
) -> bool:  # fmt: skip
    """Move the arm on by a step with a table and return True, if it is sure that no event falls in it.

    `last` says that the step cannot be halved.
    """
    mode = int(s[MODE])
    here, blocks, bodies, drivers = record(n, mode), n[BLOCKS], n[BODIES], n[DRIVERS]
    size, quantities = 2 * blocks, 2 * bodies
    inputs = size  # in w, after the new state
    start = inputs + drivers
    forces = start + quantities
    changes = forces + bodies
    varying = n[VARYING] > 0
    if mode >= GEAR_OPEN:
        return False
    for body in range(bodies if varying else 0):
        w[start + body] = dot(d, here + n[ANGLE] + body * size, s, HEADER, size)
        w[start + body] += d[here + n[HOLDS_ANGLE] + body] * s[HELD_HUB + body]
        w[start + bodies + body] = dot(d, here + n[SPEED] + body * size, s, HEADER, size)
        turns = rubs(d, n, body) and not is_stuck(mode, body)
        if turns and w[start + bodies + body] * s[HUB_DIRECTION + body] <= (-QUIET if preslides(n, body) else 0.0):
            return False
    if not varying:
        for i in range(quantities):
            w[start + i] = 0.0
    apply_laws(d, n, s, mode, s[TIME], w, start, forces)
    hub_force, motor_force = w[forces], w[forces + 1] if bodies == 2 else 0.0
    side, held_hub, held_motor, coupled = s[GEAR_SIDE], s[HELD_HUB], s[HELD_MOTOR], n[COUPLED] > 0
    w[inputs + W_COMMAND], w[inputs + W_ONE], w[inputs + W_SIDE] = command, 1.0, side
    w[inputs + W_HUB], w[inputs + W_MOTOR] = hub_force, motor_force
    w[inputs + W_HELD_HUB], w[inputs + W_HELD_MOTOR] = held_hub, held_motor
    moves = varying and (mode != (1 << bodies) - 1 or n[n[TORQUE_LAWS]] > 0)
    bends = at + PER_BLOCK * blocks
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
        i = here + n[FORCING] + 2 * k * drivers
        f1 = d[i + W_COMMAND] * command + d[i + W_HUB] * hub_force + d[i + W_ONE]
        if coupled:
            f1 += d[i + W_MOTOR] * motor_force + d[i + W_SIDE] * side
            f1 += d[i + W_HELD_HUB] * held_hub + d[i + W_HELD_MOTOR] * held_motor
        i += drivers
        f2 = d[i + W_COMMAND] * command + d[i + W_HUB] * hub_force + d[i + W_ONE]
        if coupled:
            f2 += d[i + W_MOTOR] * motor_force + d[i + W_SIDE] * side
            f2 += d[i + W_HELD_HUB] * held_hub + d[i + W_HELD_MOTOR] * held_motor
        a, b = d[here + n[C0] + k], d[here + n[C1] + k]
        i = at + PER_BLOCK * k
        c, r, r0 = tab[i], tab[i + 1], tab[i + 2]
        p, q = s[HEADER + 2 * k], s[HEADER + 2 * k + 1]
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
        if d[GAP] > 0.0:
            mesh_before += d[mesh + 2 * k] * p + d[mesh + 2 * k + 1] * q
            mesh_after += d[mesh + 2 * k] * new_p + d[mesh + 2 * k + 1] * new_q
            mesh_bend += d[mesh_weight + k] * bend
    if not keeps(d, n, s, mode, 0, hub_before, hub_after, hub_bend, moves, tab, bends, w, inputs, changes):
        return False
    if bodies == 2 and not keeps(d, n, s, mode, 1, motor_before, motor_after, motor_bend, moves, tab, bends, w, inputs, changes):
        return False
    if d[GAP] > 0.0:
        held = held_motor - held_hub  # held angles of free bodies are 0
        for body in range(bodies if moves else 0):
            mesh_bend += tab[bends + 2 * bodies + body] * variation(w, changes + body * ORDER)
        if min(side * (mesh_before + held), side * (mesh_after + held)) - 0.5 * d[GAP] <= mesh_bend:
            return False
    for i in range(size):
        s[HEADER + i] = w[i]
    s[TIME] += length
    remember(d, n, s)
    return True
