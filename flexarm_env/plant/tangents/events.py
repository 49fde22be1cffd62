"""Derivatives of the time of an event, and of the state through it."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays
from flexarm_env.plant.events import BREAK, GEARS, STOP, Event, play_edge
from flexarm_env.plant.modes import GEAR_OPEN, is_stuck, record
from flexarm_env.plant.propagate import dot
from flexarm_env.plant.stick_slip import load_now, static_budget
from flexarm_env.plant.tangents.bundles import Tangent, TangentPlaces
from flexarm_env.plant.tangents.laws import NUDGE, shift_laws
from flexarm_env.plant.tangents.motion import add_row, clear


@njit
def row_rate(a: Arrays, g: Tangent, row: int, rates: int) -> float:
    """Compute the rate of a row times the blocks' state, whose rates are in v."""
    return dot(a.d, row, g.v, rates, 2 * a.n[at.BLOCKS])


@njit
def budget_at(a: Arrays, g: Tangent, p: TangentPlaces, body: int, push: float, angle: float, time: float, load: float) -> float:
    """Compute static friction [Nm] at rest as static_budget does, at the state at the start in v."""
    own = g.v[p.start + at.TIME]
    g.v[p.start + at.TIME] = time
    found = static_budget(a.d, a.n, g.v[p.start :], body, push, angle, load)
    g.v[p.start + at.TIME] = own
    return found


@njit
def add_load(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, factor: float, out: int) -> None:
    """Add the derivatives of the load of the gears at the start, times a factor, to w at `out`."""
    d, n, v, w, gs, gd = a.d, a.n, g.v, g.w, g.s, g.d
    if n[at.BODIES] == 1:
        for x in range(w.shape[1]):
            w[out, x] += factor * d[at.LOAD_BY_COMMAND] * gs[at.COMMAND, x]
            w[out, x] += factor * gd[at.LOAD_BY_COMMAND, x] * v[p.start + at.COMMAND]
        return
    if mode >= GEAR_OPEN:
        return
    here, size = record(n, mode), 2 * n[at.BLOCKS]
    for body in range(2):
        for i in range(size):
            z, angle, speed = (
                v[p.start + at.Z_START + i],
                here + n[at.ANGLE] + body * size + i,
                here + n[at.SPEED] + body * size + i,
            )
            by = factor * (2.0 * body - 1.0) * (d[at.LOAD_STIFFNESS] * d[angle] + d[at.LOAD_DAMPING] * d[speed])
            by_stiffness, by_damping = factor * (2.0 * body - 1.0) * d[angle] * z, factor * (2.0 * body - 1.0) * d[speed] * z
            for x in range(w.shape[1]):
                own = d[at.LOAD_STIFFNESS] * gd[angle, x] + d[at.LOAD_DAMPING] * gd[speed, x]
                w[out, x] += by * gs[at.Z_START + i, x] + factor * (2.0 * body - 1.0) * own * z
                w[out, x] += by_stiffness * gd[at.LOAD_STIFFNESS, x] + by_damping * gd[at.LOAD_DAMPING, x]
        held = factor * (2.0 * body - 1.0) * d[here + n[at.HOLDS_ANGLE] + body]
        for x in range(w.shape[1]):
            w[out, x] += held * d[at.LOAD_STIFFNESS] * gs[at.HELD_HUB + body, x]
            w[out, x] += held * v[p.start + at.HELD_HUB + body] * gd[at.LOAD_STIFFNESS, x]
    side = factor * 0.5 * v[p.start + at.GEAR_SIDE]
    for x in range(w.shape[1]):
        w[out, x] -= side * (d[at.LOAD_STIFFNESS] * gd[at.GAP, x] + d[at.GAP] * gd[at.LOAD_STIFFNESS, x])


@njit(forceinline=True)
def add_budget(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, body: int, push: float, out: int) -> None:
    """Add the derivatives of static friction against a push on a held body to w at `out`."""
    d, n, v, w, gs, _gd, lanes = a.d, a.n, g.v, g.w, g.s, g.d, g.w.shape[1]
    angle, time = v[p.start + at.HELD_HUB + body], v[p.start + at.TIME]
    load = load_now(d, n, v[p.start :], mode)
    for x in range(lanes):
        step = w[p.lanes_step, x]
        if step == 0.0:
            continue
        shift_laws(a, g, p, x, step)
        above = budget_at(a, g, p, body, push, angle, time, load)
        shift_laws(a, g, p, x, -step)
        below = budget_at(a, g, p, body, push, angle, time, load)
        shift_laws(a, g, p, x, 0.0)
        w[out, x] += (above - below) / (2.0 * step)
    if not n[at.VARYING]:
        return
    by_angle = budget_at(a, g, p, body, push, angle + NUDGE, time, load)
    by_angle = (by_angle - budget_at(a, g, p, body, push, angle - NUDGE, time, load)) / (2.0 * NUDGE)
    by_time = budget_at(a, g, p, body, push, angle, time + NUDGE, load)
    by_time = (by_time - budget_at(a, g, p, body, push, angle, time - NUDGE, load)) / (2.0 * NUDGE)
    by_load = budget_at(a, g, p, body, push, angle, time, load + NUDGE)
    by_load = (by_load - budget_at(a, g, p, body, push, angle, time, load - NUDGE)) / (2.0 * NUDGE)
    for x in range(lanes):
        w[out, x] += by_angle * gs[at.HELD_HUB + body, x] + by_time * gs[at.TIME, x]
    if by_load == 0.0:
        return
    add_load(a, g, p, mode, by_load, out)


@njit(forceinline=True)
def add_push(a: Arrays, g: Tangent, p: TangentPlaces, body: int, command: float, order: int, t: float, out: int) -> float:
    """Add the derivatives of the torque on a held body that friction resists to w at `out`; return the torque.

    The blocks' state at the time t [s] is at z in v.
    """
    d, n, v, w, gs, gd = a.d, a.n, g.v, g.w, g.s, g.d
    mode, count = int(v[p.start + at.MODE]), n[at.BODIES] + n[at.POINTS]
    here = record(n, mode)
    total = add_row(a, g, here + n[at.HOLD] + body * 2 * n[at.BLOCKS], p.z, p.lanes_z, out)
    row = here + n[at.HOLD_DRIVERS] + body * n[at.DRIVERS]
    side, hub, motor = v[p.start + at.GEAR_SIDE], v[p.start + at.HELD_HUB], v[p.start + at.HELD_MOTOR]
    total += d[row + at.W_COMMAND] * command + d[row + at.W_ONE] + d[row + at.W_SIDE] * side
    total += d[row + at.W_HELD_HUB] * hub + d[row + at.W_HELD_MOTOR] * motor
    for x in range(w.shape[1]):
        w[out, x] += gd[row + at.W_COMMAND, x] * command + gd[row + at.W_ONE, x] + gd[row + at.W_SIDE, x] * side
        w[out, x] += gd[row + at.W_HELD_HUB, x] * hub + gd[row + at.W_HELD_MOTOR, x] * motor
        w[out, x] += d[row + at.W_COMMAND] * w[p.lanes_command, x]
        w[out, x] += d[row + at.W_HELD_HUB] * gs[at.HELD_HUB, x] + d[row + at.W_HELD_MOTOR] * gs[at.HELD_MOTOR, x]
    power = 1.0
    for k in range(order + 1):
        for j in range(count):
            by, own = d[here + n[at.HOLD_FORCES] + body * count + j], v[p.coefficients + k * count + j]
            total += by * own * power
            for x in range(w.shape[1]):
                change = w[p.lanes_coefficients + k * count + j, x]
                w[out, x] += power * (by * change + gd[here + n[at.HOLD_FORCES] + body * count + j, x] * own)
        power *= t / (k + 1)
    return total


@njit(forceinline=True)
def push_rate(a: Arrays, g: Tangent, p: TangentPlaces, body: int, order: int, t: float, rates: int) -> float:
    """Compute the rate of the torque on a held body that friction resists [Nm/s]."""
    d, n, v = a.d, a.n, g.v
    mode, count = int(v[p.start + at.MODE]), n[at.BODIES] + n[at.POINTS]
    here = record(n, mode)
    total, power = row_rate(a, g, here + n[at.HOLD] + body * 2 * n[at.BLOCKS], rates), 1.0
    for k in range(1, order + 1):
        for j in range(count):
            total += d[here + n[at.HOLD_FORCES] + body * count + j] * v[p.coefficients + k * count + j] * power
        power *= t / k
    return total


@njit(forceinline=True)
def write_event_lanes(a: Arrays, g: Tangent, p: TangentPlaces, event: Event, command: float, order: int, rates: int) -> None:
    """Write the derivatives of the time of an event to w at lanes_event.

    The quantity that falls to zero there is differentiated at a fixed time, and divided by its rate. State, its derivatives and
    its rates at the event are at z, lanes_z and `rates`.
    """
    d, n, v, w, gs, gd, lanes = a.d, a.n, g.v, g.w, g.s, g.d, g.w.shape[1]
    mode, size, out = int(v[p.start + at.MODE]), 2 * n[at.BLOCKS], p.lanes_event
    here, rate = record(n, mode), 0.0
    clear(w, out, 1)
    if event.kind == STOP:
        row = here + n[at.SPEED] + int(event.which) * size
        add_row(a, g, row, p.z, p.lanes_z, out)
        rate = row_rate(a, g, row, rates)
    elif event.kind == BREAK:
        body = int(event.which)
        torque = add_push(a, g, p, body, command, order, event.time, out)
        push = 1.0 if torque > 0.0 else -1.0
        for x in range(lanes):
            w[out, x] *= -push
        rate = -push * push_rate(a, g, p, body, order, event.time, rates)
        add_budget(a, g, p, mode, body, push, out)
    elif event.kind == GEARS:
        side, closed = event.which, v[p.start + at.GEAR_SIDE] == event.which
        row = here + n[at.MESH]
        edge = play_edge(d, g.v[p.start :], mode, side)
        if not closed and side * dot(d, here + n[at.WINDUP], v, p.start + at.Z_START, size) + edge <= 0.0:
            row = here + n[at.WINDUP]
        add_row(a, g, row, p.z, p.lanes_z, out)
        rate = row_rate(a, g, row, rates)
        motor, hub = 1.0 if is_stuck(mode, 1) else 0.0, 1.0 if is_stuck(mode, 0) else 0.0
        for x in range(lanes):
            w[out, x] += motor * gs[at.HELD_MOTOR, x] - hub * gs[at.HELD_HUB, x] - 0.5 * side * gd[at.GAP, x]
    for x in range(lanes):
        w[out, x] = -w[out, x] / rate if rate != 0.0 else 0.0


@njit(forceinline=True)
def write_physical_lanes(a: Arrays, g: Tangent, p: TangentPlaces) -> None:
    """Write the derivatives of the physical state, from those of the present state, to w."""
    d, n, s, w, gs, gd = a.d, a.n, a.s, g.w, g.s, g.d
    mode, size = int(s[at.MODE]), 2 * n[at.BLOCKS]
    here = record(n, mode)
    clear(w, p.lanes_physical, n[at.STATES])
    for i in range(n[at.STATES]):
        row = here + n[at.PHYSICAL] + i * size
        for j in range(size):
            by, own = d[row + j], s[at.Z_START + j]
            for x in range(w.shape[1]):
                w[p.lanes_physical + i, x] += by * gs[at.Z_START + j, x] + gd[row + j, x] * own
    for body in range(n[at.BODIES]):
        if is_stuck(mode, body):
            for x in range(w.shape[1]):
                w[p.lanes_physical + body, x] = gs[at.HELD_HUB + body, x]
                w[p.lanes_physical + n[at.COORDINATES] + body, x] = 0.0


@njit(forceinline=True)
def enter_lanes(a: Arrays, g: Tangent, p: TangentPlaces, physical: int) -> None:
    """Write the derivatives of the state in the present mode, which was entered from the physical state in w at `physical`."""
    d, n, s, w, gs, gd = a.d, a.n, a.s, g.w, g.s, g.d
    mode, size = int(s[at.MODE]), 2 * n[at.BLOCKS]
    here = record(n, mode)
    for body in range(n[at.BODIES]):
        held = 1.0 if is_stuck(mode, body) else 0.0
        for x in range(w.shape[1]):
            gs[at.HELD_HUB + body, x] = held * w[p.lanes_physical + body, x]
    clear(gs, at.Z_START, size)
    for i in range(size):
        row = here + n[at.MODAL] + i * n[at.STATES]
        for j in range(n[at.STATES]):
            by, own = d[row + j], a.w[physical + j]
            for x in range(w.shape[1]):
                gs[at.Z_START + i, x] += by * w[p.lanes_physical + j, x] + gd[row + j, x] * own
