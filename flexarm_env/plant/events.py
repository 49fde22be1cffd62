"""The next event of a step: a body that stops, a held one that breaks away, gears that part or meet."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Blocks, Line, Motion, Numbers, Places, Point, Segment, SubstepScratch
from flexarm_env.plant.crossing import amplitudes, derivative_bounds, first_crossing, point_at
from flexarm_env.plant.modes import GEAR_OPEN, is_stuck, record
from flexarm_env.plant.propagate import dot
from flexarm_env.plant.stick_slip import applied_offset, has_friction, load_now, static_budget
from flexarm_env.plant.trial_motion import arrive, copy_size, rate_at_end, start_copy

# events: none, a body stops, a held body breaks away, gears part or meet, overlapping teeth are clear of each other
NOTHING, STOP, BREAK, GEARS, AGAIN = 0, 1, 2, 3, 4


class Event(NamedTuple):
    """An event: its time [s] in the step, its kind, its body (0, 1) or its side (−1, 1)."""

    time: float
    kind: int
    which: float


@njit
def crossing_time(m: Motion, line: Line, start: float, end: float, best: float) -> float:
    """Find the time at which a quantity falls to zero within (start, min(end, best)], or `best`.

    The trial motion is advanced to it, and its state then is stored behind the trial motion.
    """
    d, w, size = m.d, m.w, 2 * m.blocks.number
    bound, fourth = derivative_bounds(m, line, m.force, end, m.sizes)
    value = line.sign * dot(d, line.row, w, m.trial, size) + line.o0 + end * (line.o1 + 0.5 * end * line.o2)
    bend = 0.125 * end * end * bound
    if value > bend and line.sign * dot(d, line.row, m.s, at.Z_START, size) + line.o0 > bend:
        return best
    before = point_at(m, line, start)
    if start > 0.0 and before.value <= 0.0:
        root = start
    elif end <= start:
        return best
    else:
        rate = line.sign * rate_at_end(m, line.row, end) + line.o1 + end * line.o2
        root = first_crossing(m, line, before, Point(end, value, rate), bound, fourth)
    if not 0.0 <= root < best:
        return best
    arrive(m, root)
    for i in range(size):
        w[m.copy + copy_size(m.blocks.number) + i] = w[m.copy + 1 + i]
    return root


@njit
def play_edge(d: Numbers, s: Numbers, mode: int, side: float) -> float:
    """Compute the offset [rad] by held angles and half the gap of the windup towards a side; teeth touch where the sum is ≥ 0."""
    held = 0.0
    if is_stuck(mode, 1):
        held += s[at.HELD_MOTOR]
    if is_stuck(mode, 0):
        held -= s[at.HELD_HUB]
    return side * held - 0.5 * d[at.GAP]


@njit
def gear_event_time(m: Motion, n: Places, start: float, end: float, side: float, best: float) -> float:
    """Find the time at which gears that touch on `side` part, or open gears meet there; else `best`.

    Teeth push and never pull: they part when their torque, damping included, falls to zero, and push again when it
    rises, or when they meet anew.
    """
    d, s, mode = m.d, m.s, int(m.s[at.MODE])
    closed = s[at.GEAR_SIDE] == side
    if not closed and not mode & GEAR_OPEN:
        return best
    here = record(n, mode)
    edge = play_edge(d, s, mode, side)
    row, weight, sign = here + n[at.MESH], here + n[at.MESH_WEIGHT], side
    if not closed:
        overlap = side * dot(d, here + n[at.WINDUP], s, at.Z_START, 2 * n[at.BLOCKS]) + edge
        sign = -side
        if overlap <= 0.0:
            row, weight = here + n[at.WINDUP], here + n[at.WINDUP_WEIGHT]
    return crossing_time(m, Line(row, weight, sign, edge if closed else -edge, 0.0, 0.0), start, end, best)


@njit
def overlap_end_time(m: Motion, n: Places, start: float, end: float, side: float, best: float) -> float:
    """Find the time at which teeth that parted while they overlapped are clear of each other; else `best`."""
    d, s, mode = m.d, m.s, int(m.s[at.MODE])
    if not mode & GEAR_OPEN:
        return best
    here = record(n, mode)
    edge = play_edge(d, s, mode, side)
    if side * dot(d, here + n[at.WINDUP], s, at.Z_START, 2 * n[at.BLOCKS]) + edge <= 0.0:
        return best
    return crossing_time(m, Line(here + n[at.WINDUP], here + n[at.WINDUP_WEIGHT], side, edge, 0.0, 0.0), start, end, best)


@njit(forceinline=True)
def breakaway_time(
    a: Arrays, m: Motion, body: int, command: float, coefficients: int, start: float, end: float, best: float
) -> float:
    """Find the time at which a held body breaks away within (start, end], else `best`; −1 if at once."""
    d, n, s, w = a.d, a.n, a.s, a.w
    mode, blocks = int(s[at.MODE]), n[at.BLOCKS]
    here = record(n, mode)
    row, weight = here + n[at.HOLD] + body * 2 * blocks, here + n[at.HOLD_WEIGHT] + body * blocks
    o0 = applied_offset(d, n, s, body, command, w, coefficients, 0)
    o1 = applied_offset(d, n, s, body, command, w, coefficients, 1) if n[at.VARYING] else 0.0
    o2 = applied_offset(d, n, s, body, command, w, coefficients, 2) if n[at.VARYING] else 0.0
    load = load_now(d, n, s, mode)
    for side in range(2):
        push = 1.0 - 2.0 * side
        budget = static_budget(d, n, s, body, push, s[at.HELD_HUB + body], load)
        if start == 0.0 and push * (o0 + dot(d, row, s, at.Z_START, 2 * blocks)) > budget:
            return -1.0
        line = Line(row, weight, -push, budget - push * o0, -push * o1, -push * o2)
        best = crossing_time(m, line, start, end, best)
    return best


@njit(forceinline=True)
def motion_of(a: Arrays, places: SubstepScratch) -> Motion:
    """Set up the motion over a substep from the present state, with its trial motion at the start."""
    n, here = a.n, record(a.n, int(a.s[at.MODE]))
    blocks = Blocks(here + n[at.C0], here + n[at.C1], n[at.BLOCKS], n[at.VARYING])
    m = Motion(a.d, a.s, a.w, blocks, places.force, places.trial, places.sizes, places.copy)
    start_copy(m)
    return m


@njit(forceinline=True)
def next_event(a: Arrays, command: float, places: SubstepScratch, start: float, end: float) -> Event:
    """Find the first event within (start, end]; kind NOTHING if there is none.

    If its time is not 0, the state at the event is in w at `found`.
    """
    d, n, s = a.d, a.n, a.s
    mode, blocks = int(s[at.MODE]), n[at.BLOCKS]
    here = record(n, mode)
    m = motion_of(a, places)
    amplitudes(m, Segment(s, at.Z_START), m.force, end, m.sizes)
    best, kind, which = 2.0 * end + 1.0, NOTHING, 0.0
    for body in range(n[at.BODIES]):
        if not has_friction(d, n, body):
            continue
        if is_stuck(mode, body):
            when = breakaway_time(a, m, body, command, places.coefficients, start, end, best)
            if when < 0.0:
                return Event(0.0, BREAK, float(body))
        else:
            row, weight = here + n[at.SPEED] + body * 2 * blocks, here + n[at.SPEED_WEIGHT] + body * blocks
            when = crossing_time(m, Line(row, weight, s[at.HUB_DIRECTION + body], 0.0, 0.0, 0.0), start, end, best)
        if when < best:
            best, kind, which = when, BREAK if is_stuck(mode, body) else STOP, float(body)
    for side in range(2 if d[at.GAP] > 0.0 else 0):
        gear_side = 1.0 - 2.0 * side
        when = gear_event_time(m, n, start, end, gear_side, best)
        if when < best:
            best, kind, which = when, GEARS, gear_side
        when = overlap_end_time(m, n, start, end, gear_side, best)
        if when < best:
            best, kind, which = when, AGAIN, gear_side
    return Event(best, kind, which)
