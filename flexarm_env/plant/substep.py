"""A substep: exact motion between events, the events, and the forces that vary with the motion."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.ahead import copy_size
from flexarm_env.plant.events import AGAIN, GEARS, NOTHING, found_at, next_event
from flexarm_env.plant.layout import Numbers, Places
from flexarm_env.plant.propagate import RESPONSE, advance, dot, respond
from flexarm_env.plant.stick_slip import GEAR_OPEN, enter, evaluate_forces, is_stuck, record, remember, settle, to_physical
from flexarm_env.plant.varying import add_forces, collocate, constant_forcing, reach

#: After an event the next is looked for this much later [s], twice as much after each further one in the same substep,
#: so that events that crowd (white noise at zero speed) cannot hold time still.
FIRST_BLIND_TIME = 1e-11
UNTABULATED = -1


@njit
def substep_scratch(n: Places) -> int:
    """How many numbers of scratch a substep needs."""
    count = n[at.BODIES] + n[at.POINTS]
    return 26 * n[at.BLOCKS] + copy_size(n[at.BLOCKS]) + n[at.STATES] + (14 + 12 * count) * count + 64


@njit(forceinline=True)
def happen(
    d: Numbers, n: Places, s: Numbers, kind: int, which: float, command: float, w: Numbers,
    physical: int, coefficients: int,
) -> None:  # fmt: skip
    """Let an event take place."""
    mode = int(s[at.MODE])
    if kind == AGAIN:
        return
    if kind != GEARS:
        settle(d, n, s, int(which), command, w, physical, coefficients)
        return
    to_physical(d, n, s, mode, w, physical)
    if mode & GEAR_OPEN:
        s[at.GEAR_SIDE] = which
        enter(d, n, s, mode & ~GEAR_OPEN, w, physical)
    else:
        s[at.GEAR_SIDE] = 0.0
        enter(d, n, s, mode | GEAR_OPEN, w, physical)


@njit(forceinline=True)
def face_motion(d: Numbers, n: Places, s: Numbers, mode: int) -> None:
    """Let friction oppose the motion of a state that was set or corrected from outside."""
    size = 2 * n[at.BLOCKS]
    for body in range(n[at.BODIES]):
        if not is_stuck(mode, body):
            speed = dot(d, record(n, mode) + n[at.SPEED] + body * size, s, at.HEADER, size)
            if speed * s[at.HUB_DIRECTION + body] < 0.0:
                s[at.HUB_DIRECTION + body] *= -1.0


@njit
def substep(d: Numbers, n: Places, s: Numbers, command: float, t: float, slot: int, w: Numbers) -> None:
    """Move the arm on by t [s] under a held command; `slot` names the tabulated responses for exactly t."""
    blocks = n[at.BLOCKS]
    size, count = 2 * n[at.BLOCKS], n[at.BODIES] + n[at.POINTS]
    trial, force = 0, size
    coefficients = force + 3 * size
    nodes = coefficients + 3 * count
    motion = nodes + 5 * count
    sizes = motion + 6 * count
    found = found_at(sizes, blocks)
    own = found + size
    own_reach = own + 2 * RESPONSE * blocks
    physical = own_reach + (12 * count * count if n[at.VARYING] else 0)
    shift = (2 * n[at.BODIES] + n[at.POINTS]) * 3 * count
    left, blind = t, 0.0
    face_motion(d, n, s, int(s[at.MODE]))
    while left > 0.0:
        mode = int(s[at.MODE])
        here = record(n, mode)
        c0, c1 = here + n[at.C0], here + n[at.C1]
        known = slot >= 0 and blind == 0.0
        table = d if known else w
        middle = here + n[at.RESPONSES] + slot * 2 * RESPONSE * blocks if known else own
        end = middle + RESPONSE * blocks
        if not known:
            respond(d, c0, c1, blocks, left, w, end)
        if n[at.VARYING]:
            shifts = here + n[at.REACH] + slot * 2 * shift if known else own_reach
            if not known:
                respond(d, c0, c1, blocks, 0.5 * left, w, middle)
                reach(d, n, mode, w, middle, w, own_reach)
                reach(d, n, mode, w, end, w, own_reach + shift)
            collocate(d, n, s, mode, command, left, table, middle, table, shifts, w, trial, nodes, motion, force, coefficients)
        else:
            constant_forcing(d, n, s, command, mode, w, force)
            evaluate_forces(d, n, s, mode, mode, w, coefficients)
            add_forces(d, n, mode, w, coefficients, force)
        advance(d, c0, c1, blocks, table, end, s, at.HEADER, w, force, n[at.VARYING], trial)
        when, kind, which = next_event(d, n, s, mode, command, w, trial, force, coefficients, sizes, min(blind, left), left)
        when = left if kind == NOTHING else when
        if when > 0.0:
            for i in range(size):
                s[at.HEADER + i] = w[(trial if kind == NOTHING else found) + i]
            s[at.TIME] += when
        remember(d, n, s)
        if kind == NOTHING:
            return
        happen(d, n, s, kind, which, command, w, physical, coefficients)
        left -= when
        blind = max(2.0 * blind, FIRST_BLIND_TIME)
