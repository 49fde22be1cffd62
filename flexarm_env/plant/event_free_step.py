"""An event-free step of any arm without drag: two bodies, gears, and forces that vary with the motion."""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays
from flexarm_env.plant.event_free_table import ORDER, StepTable, tested_row
from flexarm_env.plant.force_quartic import StepScratch, fit_quartic, step_places, variation
from flexarm_env.plant.forces import apply_laws
from flexarm_env.plant.friction import preslides
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.modes import GEAR_OPEN, is_stuck, record
from flexarm_env.plant.propagate import dot
from flexarm_env.plant.stick_slip import has_friction, load_now, remember_friction, static_budget

#: Speed [rad/s] below which the moment of reversal does not matter to presliding friction.
QUIET = 1e-4


class Chord(NamedTuple):
    """A tested row before and after a step, and a bound of its distance from the line between the two."""

    before: float
    after: float
    bend: float


@njit(forceinline=True)
def start_forces(a: Arrays, places: StepScratch) -> bool:
    """Write motion and forces at the start; return False if a body turns against friction's direction."""
    d, n, s, w = a.d, a.n, a.s, a.w
    mode, bodies, size = int(s[at.MODE]), n[at.BODIES], 2 * n[at.BLOCKS]
    here, start, varying = record(n, mode), places.start, n[at.VARYING] > 0
    for body in range(bodies if varying else 0):
        w[start + body] = dot(d, here + n[at.ANGLE] + body * size, s, at.Z_START, size)
        w[start + body] += d[here + n[at.HOLDS_ANGLE] + body] * s[at.HELD_HUB + body]
        w[start + bodies + body] = dot(d, here + n[at.SPEED] + body * size, s, at.Z_START, size)
        turns = has_friction(d, n, body) and not is_stuck(mode, body)
        if turns and w[start + bodies + body] * s[at.HUB_DIRECTION + body] <= (-QUIET if preslides(n, body) else 0.0):
            return False
    if not varying:
        for i in range(2 * bodies):
            w[start + i] = 0.0
    apply_laws(a, mode, s[at.TIME], start, places.forces)
    return True


@njit(forceinline=True)
def write_inputs(a: Arrays, command: float, places: StepScratch) -> None:
    """Write the drivers: the command, the forces at the start, the constant 1, the gears' side and the held angles."""
    s, w, inputs = a.s, a.w, places.inputs
    w[inputs + at.W_COMMAND], w[inputs + at.W_ONE], w[inputs + at.W_SIDE] = command, 1.0, s[at.GEAR_SIDE]
    w[inputs + at.W_HUB] = w[places.forces]
    w[inputs + at.W_MOTOR] = w[places.forces + 1] if a.n[at.BODIES] == 2 else 0.0
    w[inputs + at.W_HELD_HUB], w[inputs + at.W_HELD_MOTOR] = s[at.HELD_HUB], s[at.HELD_MOTOR]


@njit(forceinline=True)
def force_blocks(a: Arrays, places: StepScratch) -> None:
    """Write the force on each block at the start to w, from the drivers."""
    d, n, w, inputs, size = a.d, a.n, a.w, places.inputs, 2 * a.n[at.BLOCKS]
    by, to = record(n, int(a.s[at.MODE])) + n[at.FORCING], places.block_forces
    command, hub, motor = w[inputs + at.W_COMMAND], w[inputs + at.W_HUB], w[inputs + at.W_MOTOR]
    for i in range(size):
        force = d[by + at.W_COMMAND * size + i] * command + d[by + at.W_HUB * size + i] * hub
        w[to + i] = force + d[by + at.W_MOTOR * size + i] * motor + d[by + at.W_ONE * size + i]
    side, held_hub, held_motor = w[inputs + at.W_SIDE], w[inputs + at.W_HELD_HUB], w[inputs + at.W_HELD_MOTOR]
    if side == 0.0 and held_hub == 0.0 and held_motor == 0.0:
        return
    for i in range(size):
        force = d[by + at.W_SIDE * size + i] * side + d[by + at.W_HELD_HUB * size + i] * held_hub
        w[to + i] += force + d[by + at.W_HELD_MOTOR * size + i] * held_motor


@njit(forceinline=True)
def move_blocks(a: Arrays, moves: bool, table: StepTable, places: StepScratch) -> None:
    """Write each block's state at the end of the step, and the bound of its chord error, to w."""
    d, n, s, w, tab = a.d, a.n, a.s, a.w, table.data
    blocks, changes, here = n[at.BLOCKS], n[at.BODIES] * ORDER, record(n, int(s[at.MODE]))
    at0, at1, forces, responses = here + n[at.C0], here + n[at.C1], places.block_forces, table.responses
    force_blocks(a, places)
    for k in range(blocks):
        c0, c1 = d[at0 + k], d[at1 + k]
        c, r, r0 = tab[responses + k], tab[responses + blocks + k], tab[responses + 2 * blocks + k]
        f1, f2, p, q = w[forces + 2 * k], w[forces + 2 * k + 1], s[at.Z_START + 2 * k], s[at.Z_START + 2 * k + 1]
        x, y = q + f1, f2 - c0 * p - c1 * q
        w[2 * k] = p + (r + c1 * r0) * x + r0 * y
        w[2 * k + 1] = c * x + r * y - f1
        w[places.bends + k] = tab[responses + 3 * blocks + k] * math.sqrt(c0 * x * x + y * y)
    if moves:
        for j in range(changes):
            change, end = w[places.changes + j], table.ends + 2 * j * blocks
            for i in range(2 * blocks):
                w[i] += tab[end + i] * change


@njit(forceinline=True)
def chord_of(a: Arrays, row: int, places: StepScratch) -> Chord:
    """Compute the chord of the row that is tested for a body's event, or (last) for the gears'."""
    d, s, w = a.d, a.s, a.w
    place, weight = tested_row(a.n, int(s[at.MODE]), row)
    blocks = a.n[at.BLOCKS]
    before, after = inner_product(d, place, s, at.Z_START, 2 * blocks), inner_product(d, place, w, 0, 2 * blocks)
    return Chord(before, after, inner_product(d, weight, w, places.bends, blocks))


@njit(forceinline=True)
def body_keeps_state(a: Arrays, body: int, moves: bool, table: StepTable, places: StepScratch) -> bool:
    """Whether a body certainly keeps turning, or stays held, over the step."""
    d, n, s, w = a.d, a.n, a.s, a.w
    if not has_friction(d, n, body):
        return True
    chord = chord_of(a, body, places)
    before, after, bend = chord.before, chord.after, chord.bend
    if preslides(n, body) and max(abs(before), abs(after)) + bend < QUIET:
        return True
    mode, bodies = int(s[at.MODE]), n[at.BODIES]
    here, stuck = record(n, mode), is_stuck(mode, body)
    for other in range(bodies if moves else 0):
        turned = variation(w, places.changes + other * ORDER)
        bend += table.data[table.bends + body * bodies + other] * turned
        if stuck:
            bend += abs(d[here + n[at.HOLD_FORCES] + body * bodies + other]) * turned
    if not stuck:
        return min(before * s[at.HUB_DIRECTION + body], after * s[at.HUB_DIRECTION + body]) > bend
    offset = dot(d, here + n[at.HOLD_DRIVERS] + body * n[at.DRIVERS], w, places.inputs, n[at.DRIVERS])
    angle, load = s[at.HELD_HUB + body], load_now(d, n, s, mode)
    high, low = static_budget(d, n, s, body, 1.0, angle, load), static_budget(d, n, s, body, -1.0, angle, load)
    return max(before, after) + offset + bend <= high and min(before, after) + offset - bend >= -low  # 0 where nothing pushes


@njit(forceinline=True)
def gears_keep_touching(a: Arrays, moves: bool, table: StepTable, places: StepScratch) -> bool:
    """Whether gears with play certainly keep touching over the step."""
    s, bodies, side = a.s, a.n[at.BODIES], a.s[at.GEAR_SIDE]
    chord = chord_of(a, bodies, places)
    held, bend = s[at.HELD_MOTOR] - s[at.HELD_HUB], chord.bend  # held angles of free bodies are 0
    for body in range(bodies if moves else 0):
        bend += table.data[table.bends + 2 * bodies + body] * variation(a.w, places.changes + body * ORDER)
    return not min(side * (chord.before + held), side * (chord.after + held)) - 0.5 * a.d[at.GAP] <= bend


@njit
def event_free_step(a: Arrays, command: float, length: float, last: bool, table: StepTable) -> bool:
    """Advance the arm by a step with a table and return True, if certainly no event falls in it.

    With `last` the step cannot be halved.
    """
    d, n, s, w = a.d, a.n, a.s, a.w
    mode, places = int(s[at.MODE]), step_places(n)
    if mode >= GEAR_OPEN or not start_forces(a, places):
        return False
    write_inputs(a, command, places)
    moves = n[at.VARYING] > 0 and (mode != (1 << n[at.BODIES]) - 1 or n[n[at.TORQUE_LAWS]] > 0)
    if moves and not (fit_quartic(a, length, last, table, places) or last):
        return False
    move_blocks(a, moves, table, places)
    for body in range(n[at.BODIES]):
        if not body_keeps_state(a, body, moves, table, places):
            return False
    if d[at.GAP] > 0.0 and not gears_keep_touching(a, moves, table, places):
        return False
    for i in range(2 * n[at.BLOCKS]):
        s[at.Z_START + i] = w[i]
    s[at.TIME] += length
    remember_friction(d, n, s)
    return True
