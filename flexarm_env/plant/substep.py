"""A substep: exact motion from event to event, under forces that vary with the motion."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Blocks, Numbers, Places, Segment, SubstepScratch
from flexarm_env.plant.events import AGAIN, GEARS, NOTHING, Event, next_event
from flexarm_env.plant.force_parabola import add_forces, constant_forcing, fit_forces, force_influence, influence_size
from flexarm_env.plant.forces import evaluate_forces
from flexarm_env.plant.modes import GEAR_OPEN, is_stuck, record
from flexarm_env.plant.propagate import RESPONSE, advance, dot, respond
from flexarm_env.plant.stick_slip import decide_stick_or_slip, enter_mode, remember_friction, to_physical
from flexarm_env.plant.trial_motion import copy_size

#: Time [s] after an event in which no other is searched, doubled with each further one in the same substep, so that a crowd of
#: events (white noise at zero speed) cannot stop time.
FIRST_BLIND_TIME = 1e-11
UNTABULATED = -1


@njit(forceinline=True)
def substep_places(n: Places) -> SubstepScratch:
    """Lay out the scratch of a substep."""
    blocks, count = n[at.BLOCKS], n[at.BODIES] + n[at.POINTS]
    size = 2 * blocks
    force = size
    coefficients = force + 3 * size
    nodes = coefficients + 3 * count
    motion = nodes + 5 * count
    sizes = motion + 6 * count
    copy = sizes + 2 * size
    found = copy + copy_size(blocks)
    responses = found + size
    influence = responses + 2 * RESPONSE * blocks
    physical = influence + (2 * influence_size(n) if n[at.VARYING] else 0)
    return SubstepScratch(0, force, coefficients, nodes, motion, sizes, copy, found, responses, influence, physical)


@njit
def substep_scratch(n: Places) -> int:
    """Count the numbers of scratch of a substep."""
    return substep_places(n).physical + n[at.STATES]


@njit(forceinline=True)
def apply_event(a: Arrays, event: Event, command: float, places: SubstepScratch) -> None:
    """Change the mode at an event."""
    d, n, s, w = a.d, a.n, a.s, a.w
    mode, physical = int(s[at.MODE]), places.physical
    if event.kind == AGAIN:
        return
    if event.kind != GEARS:
        decide_stick_or_slip(a, int(event.which), command, physical, places.coefficients)
        return
    to_physical(d, n, s, mode, w, physical)
    if mode & GEAR_OPEN:
        s[at.GEAR_SIDE] = event.which
        enter_mode(d, n, s, mode & ~GEAR_OPEN, w, physical)
    else:
        s[at.GEAR_SIDE] = 0.0
        enter_mode(d, n, s, mode | GEAR_OPEN, w, physical)


@njit(forceinline=True)
def oppose_motion(d: Numbers, n: Places, s: Numbers, mode: int) -> None:
    """Turn friction against the motion of a state that was set or corrected from outside."""
    size = 2 * n[at.BLOCKS]
    for body in range(n[at.BODIES]):
        if not is_stuck(mode, body):
            speed = dot(d, record(n, mode) + n[at.SPEED] + body * size, s, at.Z_START, size)
            if speed * s[at.HUB_DIRECTION + body] < 0.0:
                s[at.HUB_DIRECTION + body] *= -1.0


@njit(forceinline=True)
def find_forces(a: Arrays, command: float, t: float, slot: int, places: SubstepScratch) -> Segment:
    """Write the forces on the blocks over t [s]; return the table of the blocks' responses after t.

    `slot` is the number of the tables for exactly t, or UNTABULATED.
    """
    d, n, w = a.d, a.n, a.w
    mode, blocks, known = int(a.s[at.MODE]), n[at.BLOCKS], slot >= 0
    here = record(n, mode)
    c0, c1 = here + n[at.C0], here + n[at.C1]
    middle = Segment(d if known else w, here + n[at.RESPONSES] + slot * 2 * RESPONSE * blocks if known else places.responses)
    end = Segment(middle.data, middle.first + RESPONSE * blocks)
    if not known:
        respond(d, c0, c1, blocks, t, w, end.first)
    if not n[at.VARYING]:
        constant_forcing(a, command, mode, places.force)
        evaluate_forces(a, mode, mode, places.coefficients)
        add_forces(d, n, mode, w, places.coefficients, places.force)
        return end
    size = influence_size(n)
    shifts = Segment(middle.data, here + n[at.STEP_TABLES] + slot * 2 * size if known else places.influence)
    if not known:
        respond(d, c0, c1, blocks, 0.5 * t, w, middle.first)
        force_influence(d, n, mode, middle, shifts)
        force_influence(d, n, mode, end, Segment(w, shifts.first + size))
    fit_forces(a, command, t, middle, shifts, places)
    return end


@njit
def substep(a: Arrays, command: float, t: float, slot: int) -> None:
    """Advance the arm by t [s] under a held command; `slot` is the number of the tables for exactly t, or UNTABULATED."""
    d, n, s, w = a.d, a.n, a.s, a.w
    places = substep_places(n)
    left, blind = t, 0.0
    oppose_motion(d, n, s, int(s[at.MODE]))
    while left > 0.0:
        table = find_forces(a, command, left, slot if blind == 0.0 else UNTABULATED, places)
        here = record(n, int(s[at.MODE]))
        blocks = Blocks(here + n[at.C0], here + n[at.C1], n[at.BLOCKS], n[at.VARYING])
        advance(d, blocks, table, Segment(s, at.Z_START), w, places.force, places.trial)
        event = next_event(a, command, places, min(blind, left), left)
        nothing = event.kind == NOTHING
        when = left if nothing else event.time
        if when > 0.0:
            for i in range(2 * n[at.BLOCKS]):
                s[at.Z_START + i] = w[(places.trial if nothing else places.found) + i]
            s[at.TIME] += when
        remember_friction(d, n, s)
        if nothing:
            return
        apply_event(a, event, command, places)
        left -= when
        blind = max(2.0 * blind, FIRST_BLIND_TIME)
