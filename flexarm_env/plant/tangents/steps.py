"""The steps of a replay with derivatives, of whole substeps and of parts: each is followed by its derivatives."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Blocks, Segment
from flexarm_env.plant.control_step import hub_rests, table_place
from flexarm_env.plant.event_free_step import event_free_step
from flexarm_env.plant.event_free_table import DEPTH, ORDER, prepare_step_table, step_table, tabulated_step
from flexarm_env.plant.events import GEARS, NOTHING, Event, next_event
from flexarm_env.plant.force_quartic import step_places
from flexarm_env.plant.forces import effect_torque
from flexarm_env.plant.friction import preslides
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.propagate import advance
from flexarm_env.plant.quiet_step import quiet_step
from flexarm_env.plant.stick_slip import remember_friction
from flexarm_env.plant.substep import FIRST_BLIND_TIME, UNTABULATED, apply_event, find_forces, oppose_motion, substep_places
from flexarm_env.plant.tangents.bundles import KEY_LENGTH, KEY_SEARCHED, MOST_ORDERS, PER_TABLE, Tangent, TangentPlaces
from flexarm_env.plant.tangents.collocation import FACTORIALS, fit_lanes
from flexarm_env.plant.tangents.events import enter_lanes, write_event_lanes, write_physical_lanes
from flexarm_env.plant.tangents.laws import NUDGE, add_law_lanes, add_slope_lanes, shift_laws, write_arguments, write_slopes
from flexarm_env.plant.tangents.motion import block_rates, clear, keep_state, move_lanes
from flexarm_env.plant.tangents.response import tabulate_responses
from flexarm_env.plant.tangents.steady import forget_ones, is_steady, steady_lanes, write_steady_force


@njit(forceinline=True)
def end_lanes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, order: int, t: float, slot: int) -> int:
    """Write the state t [s] after the start, its rates and its derivatives at that time; return the place of the rates in v.

    `slot` is the number of the tables for exactly t, or UNTABULATED.
    """
    size = a.n[at.BLOCKS] * PER_TABLE
    table = p.tables + MOST_ORDERS * size
    rates = table
    if slot >= 0:
        table = p.steady_tables + (2 * mode + slot) * size
    elif order > 0 and g.v[p.keys + KEY_LENGTH] == t:
        table = p.tables + (order - 1) * size
    else:
        tabulate_responses(a.d, a.n, mode, t, g.v, table)
    move_lanes(a, g, p, mode, order, table)
    block_rates(a, g, p, mode, order, t, rates)
    return rates


@njit(forceinline=True)
def finish_lanes(a: Arrays, g: Tangent, p: TangentPlaces, rates: int, late: int) -> None:
    """Take the derivatives at the end of a step over to the state's; row `late` of w has those of its time."""
    v, w, gs = g.v, g.w, g.s
    for i in range(2 * a.n[at.BLOCKS]):
        for x in range(w.shape[1]):
            gs[at.Z_START + i, x] = w[p.lanes_z + i, x] + v[rates + i] * w[late, x]
    for x in range(w.shape[1]):
        gs[at.TIME, x] += w[late, x]


@njit
def remember_lanes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, time: float) -> None:
    """Write the derivatives of the angle and friction that a hub that preslides remembers, at the end of a step.

    Its friction is the force of the laws without the effects' torque.
    """
    d, n, v, w, gs = a.d, a.n, g.v, g.w, g.s
    if not preslides(n, 0) or is_stuck(mode, 0):
        return
    for i in range(2 * n[at.BLOCKS]):
        for x in range(w.shape[1]):
            w[p.lanes_z + i, x] = gs[at.Z_START + i, x]
    clear(w, p.lanes_event, 1)
    write_arguments(a, g, p, mode, p.lanes_event)
    write_slopes(a, g, p, mode, time, 0)
    clear(w, p.lanes_node, n[at.BODIES] + n[at.POINTS])
    add_slope_lanes(a, g, p, 0, p.lanes_node)
    add_law_lanes(a, g, p, mode, time, p.lanes_node)
    bodies = n[at.BODIES]
    angle, speed = v[p.motion], v[p.motion + bodies]
    late = p.lanes_motion + 2 * bodies + n[at.POINTS]
    by_angle = effect_torque(d, n, 0, angle + NUDGE, speed, time) - effect_torque(d, n, 0, angle - NUDGE, speed, time)
    by_speed = effect_torque(d, n, 0, angle, speed + NUDGE, time) - effect_torque(d, n, 0, angle, speed - NUDGE, time)
    by_time = effect_torque(d, n, 0, angle, speed, time + NUDGE) - effect_torque(d, n, 0, angle, speed, time - NUDGE)
    for x in range(w.shape[1]):
        torque = by_angle * w[p.lanes_motion, x] + by_speed * w[p.lanes_motion + bodies, x] + by_time * w[late, x]
        torque /= 2.0 * NUDGE
        step = w[p.lanes_step, x]
        if step != 0.0:
            shift_laws(a, g, p, x, step)
            above = effect_torque(d, n, 0, angle, speed, time)
            shift_laws(a, g, p, x, -step)
            below = effect_torque(d, n, 0, angle, speed, time)
            shift_laws(a, g, p, x, 0.0)
            torque += (above - below) / (2.0 * step)
        gs[at.KNOWN_ANGLE, x] = w[p.lanes_motion, x]
        gs[at.KNOWN_FRICTION, x] = torque - w[p.lanes_node, x]


@njit
def whole_lanes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, command: float, order: int, t: float, slot: int) -> None:
    """Carry the derivatives over a step without events, from the laws' forces in v."""
    fit_lanes(a, g, p, mode, command, order, t)
    rates = end_lanes(a, g, p, mode, order, t, slot)
    finish_lanes(a, g, p, rates, p.lanes_left)
    remember_lanes(a, g, p, mode, g.v[p.start + at.TIME] + t)


@njit(forceinline=True)
def quiet_lanes(a: Arrays, g: Tangent, p: TangentPlaces, command: float, length: float, slot: int) -> bool:
    """Take a quiet step with derivatives."""
    keep_state(a, g, p)
    if not quiet_step(a, command, length, slot):
        return False
    mode = int(g.v[p.start + at.MODE])
    if is_steady(a.n):
        steady_lanes(a, g, p, mode, command, slot)
        return True
    write_steady_force(a, g, p, mode)
    whole_lanes(a, g, p, mode, command, 0, length, slot)
    return True


@njit
def event_free_lanes(
    a: Arrays, g: Tangent, p: TangentPlaces, command: float, length: float, last: bool, slot: int, level: int
) -> bool:
    """Take an event-free step with derivatives; a slot below 0 uses the table behind the scratch."""
    d, n, w, v = a.d, a.n, a.w, g.v
    mode, bodies = int(a.s[at.MODE]), n[at.BODIES]
    keep_state(a, g, p)
    table = step_table(n, w, table_place(n)) if slot < 0 else tabulated_step(d, n, mode, slot, level)
    if not event_free_step(a, command, length, last, table):
        return False
    if slot >= 0 and is_steady(n):
        steady_lanes(a, g, p, mode, command, slot)
        return True
    places = step_places(n)
    moves = n[at.VARYING] > 0 and (mode != (1 << bodies) - 1 or n[n[at.TORQUE_LAWS]] > 0)
    for body in range(bodies):
        v[p.coefficients + body] = w[places.forces + body]
        for power in range(1, ORDER + 1 if moves else 1):
            change = w[places.changes + body * ORDER + power - 1]
            v[p.coefficients + power * bodies + body] = change * FACTORIALS[power] / length**power
    whole_lanes(a, g, p, mode, command, ORDER if moves else 0, length, UNTABULATED)
    return True


@njit(forceinline=True)
def event_lanes(a: Arrays, g: Tangent, p: TangentPlaces, event: Event, command: float, order: int, rates: int) -> None:
    """Carry the derivatives to an event; that of an event where its search starts, `searched` in v, does not move."""
    if event.time <= g.v[p.keys + KEY_SEARCHED]:
        clear(g.w, p.lanes_event, 1)
    else:
        write_event_lanes(a, g, p, event, command, order, rates)
    finish_lanes(a, g, p, rates, p.lanes_event)
    for x in range(g.w.shape[1]):
        g.w[p.lanes_left, x] -= g.w[p.lanes_event, x]


@njit(forceinline=True)
def apply_with_lanes(a: Arrays, g: Tangent, p: TangentPlaces, event: Event, command: float) -> None:
    """Change the mode at an event, with derivatives."""
    n, s, places, before = a.n, a.s, substep_places(a.n), a.s[at.MODE]
    write_physical_lanes(a, g, p)
    apply_event(a, event, command, places)
    if s[at.MODE] == before:
        return
    if event.kind != GEARS:
        clear(g.w, p.lanes_physical + n[at.COORDINATES] + int(event.which), 1)
    enter_lanes(a, g, p, places.physical)
    forget_ones(g, p)


@njit
def substep_lanes(a: Arrays, g: Tangent, p: TangentPlaces, command: float, t: float, slot: int) -> None:
    """Take a substep, from event to event, with derivatives; row lanes_left of w has those of t."""
    d, n, s, w = a.d, a.n, a.s, a.w
    places, count, order = substep_places(n), n[at.BODIES] + n[at.POINTS], 2 if n[at.VARYING] else 0
    left, blind = t, 0.0
    oppose_motion(d, n, s, int(s[at.MODE]))
    while left > 0.0:
        keep_state(a, g, p)
        mode, now = int(s[at.MODE]), slot if blind == 0.0 else UNTABULATED
        table = find_forces(a, command, left, now, places)
        here = record(n, mode)
        blocks = Blocks(here + n[at.C0], here + n[at.C1], n[at.BLOCKS], n[at.VARYING])
        advance(d, blocks, table, Segment(s, at.Z_START), w, places.force, places.trial)
        event = next_event(a, command, places, min(blind, left), left)
        nothing = event.kind == NOTHING
        when = left if nothing else event.time
        for i in range((order + 1) * count):
            g.v[p.coefficients + i] = w[places.coefficients + i]
        g.v[p.keys + KEY_SEARCHED] = min(blind, left)
        if when > 0.0:
            fit_lanes(a, g, p, mode, command, order, left)
            rates = end_lanes(a, g, p, mode, order, when, now if nothing else UNTABULATED)
            if nothing:
                finish_lanes(a, g, p, rates, p.lanes_left)
            else:
                event_lanes(a, g, p, event, command, order, rates)
            remember_lanes(a, g, p, mode, s[at.TIME] + when)
            for i in range(2 * n[at.BLOCKS]):
                s[at.Z_START + i] = w[(places.trial if nothing else places.found) + i]
            s[at.TIME] += when
        remember_friction(d, n, s)
        if nothing:
            return
        apply_with_lanes(a, g, p, event, command)
        left -= when
        blind = max(2.0 * blind, FIRST_BLIND_TIME)


@njit(forceinline=True)
def share_left(g: Tangent, p: TangentPlaces, share: float) -> None:
    """Write the derivatives of a part of the step's length."""
    for x in range(g.w.shape[1]):
        g.w[p.lanes_left, x] = share * g.w[p.lanes_length, x]


@njit
def halving_lanes(a: Arrays, g: Tangent, p: TangentPlaces, command: float, t: float, slot: int) -> None:
    """Advance by t [s] as halving_steps does, with derivatives."""
    d, n, s, w = a.d, a.n, a.s, a.w
    whole, done, level = 1 << DEPTH, 0, 0
    own, own_mode, own_level = step_table(n, w, table_place(n)), UNTABULATED, 0
    while done < whole:
        mode, part = int(s[at.MODE]), whole >> level
        length = t * 0.5**level
        share_left(g, p, 0.5**level)
        if slot >= 0 and level == 0 and hub_rests(n, mode):
            moved = quiet_lanes(a, g, p, command, length, slot)
        else:
            if slot < 0 and (own_mode != mode or own_level != level):
                prepare_step_table(d, n, mode, length, own)
                own_mode, own_level = mode, level
            moved = event_free_lanes(a, g, p, command, length, level == DEPTH, slot, level)
        if not moved and level < DEPTH:
            level += 1
            continue
        if not moved:
            substep_lanes(a, g, p, command, length, UNTABULATED)
        done += part
        if level > 0 and done % (2 * part) == 0:
            level -= 1


@njit
def move_with_lanes(a: Arrays, g: Tangent, p: TangentPlaces, command: float, t: float, slot: int) -> None:
    """Advance by t [s] as move does, with derivatives; row lanes_length of w has those of t."""
    n = a.n
    share_left(g, p, 1.0)
    if n[at.VARYING] and not n[at.POINTS]:
        halving_lanes(a, g, p, command, t, slot)
        return
    if n[at.STEADY_BODIES] == 2 and slot >= 0 and event_free_lanes(a, g, p, command, t, True, slot, 0):
        return
    share_left(g, p, 1.0)
    substep_lanes(a, g, p, command, t, slot)


@njit
def begin_step(g: Tangent, p: TangentPlaces, slot: int) -> None:
    """Write the derivatives of the length of a tabulated substep."""
    for x in range(g.w.shape[1]):
        g.w[p.lanes_length, x] = g.d[at.EARLY_LENGTH + slot, x]
    share_left(g, p, 1.0)


@njit(forceinline=True)
def step_lanes(a: Arrays, g: Tangent, p: TangentPlaces, command: float, length: float, slot: int) -> None:
    """Advance by one tabulated substep of a sample, with derivatives."""
    steady = is_steady(a.n)
    if not steady:
        begin_step(g, p, slot)
    if a.n[at.STEADY_BODIES] == 1 and quiet_lanes(a, g, p, command, length, slot):
        return
    if steady:
        begin_step(g, p, slot)
    move_with_lanes(a, g, p, command, length, slot)
