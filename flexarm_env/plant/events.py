"""The next event of a step: a body that stops, a held one that breaks away, gears that part or meet."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.ahead import arrive, copy_size, rate_of, start_copy, value_at
from flexarm_env.plant.crossing import amplitudes, curvature_bound, first_crossing
from flexarm_env.plant.layout import Numbers, Places
from flexarm_env.plant.propagate import dot
from flexarm_env.plant.stick_slip import GEAR_OPEN, applied_offset, is_stuck, load_now, record, rubs, static_budget

# events: none, a body that stops, a held body that breaks away, gears that part or meet, a moment to look afresh
NOTHING, STOP, BREAK, GEARS, AGAIN = 0, 1, 2, 3, 4


@njit
def found_at(size: int, blocks: int) -> int:
    """Where next_event leaves the state at the event in w: behind the amplitudes at `size` and a copy of the motion."""
    return size + 2 * blocks + copy_size(blocks)


@njit
def look(
    d: Numbers, n: Places, mode: int, row: int, weight: int, sign: float, o0: float, o1: float,
    o2: float, s: Numbers, w: Numbers, trial: int, force: int, size: int, start: float, end: float,
    best: float,
) -> float:  # fmt: skip
    """Return when sign · (row · z) + o₀ + o₁ t + o₂ t²/2 falls to zero within (start, min(end, best)], or `best`.

    z is the state now; the one at `end` stands in w at `trial`. The state then is left behind the copy after `size`.
    """
    here = record(n, mode)
    c0, c1, blocks = here + n[at.C0], here + n[at.C1], n[at.BLOCKS]
    bound = curvature_bound(d, row, weight, blocks, w, size, force, n[at.VARYING], end) + abs(o2)
    fourth = dot(d, weight, w, size + blocks, blocks)
    value = sign * dot(d, row, w, trial, 2 * blocks) + o0 + end * (o1 + 0.5 * end * o2)
    bend = 0.125 * end * end * bound
    if value > bend and sign * dot(d, row, s, at.HEADER, 2 * blocks) + o0 > bend:
        return best
    clock = size + 2 * blocks
    before, slope, _ = value_at(d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, n[at.VARYING], clock, start)
    if start > 0.0 and before <= 0.0:
        root = start
    elif end <= start:
        return best
    else:
        rate = sign * rate_of(d, row, c0, c1, blocks, w, trial, w, force, end) + o1 + end * o2
        root = first_crossing(
            d, row, sign, o0, o1, o2, c0, c1, blocks, s, w, force, n[at.VARYING], clock, start, end,
            before, slope, value, rate, bound, fourth,
        )  # fmt: skip
    if not 0.0 <= root < best:
        return best
    arrive(d, c0, c1, blocks, s, w, force, n[at.VARYING], clock, root)
    for i in range(2 * blocks):
        w[found_at(size, blocks) + i] = w[clock + 1 + i]
    return root


@njit
def play_edge(d: Numbers, s: Numbers, mode: int, side: float) -> float:
    """Return what the angles of held bodies and half the gap add to the windup towards a side: teeth touch from 0 up."""
    held = 0.0
    if is_stuck(mode, 1):
        held += s[at.HELD_MOTOR]
    if is_stuck(mode, 0):
        held -= s[at.HELD_HUB]
    return side * held - 0.5 * d[at.GAP]


@njit
def look_at_gears(
    d: Numbers, n: Places, s: Numbers, mode: int, w: Numbers, trial: int, force: int, size: int,
    start: float, end: float, side: float, best: float,
) -> float:  # fmt: skip
    """Return when gears that touch on `side` part, or open gears meet there; else `best`.

    Teeth push and never pull: they part when their torque, damping included, falls to zero, and push again when it
    rises, or when they meet anew.
    """
    closed = s[at.GEAR_SIDE] == side
    if not closed and not mode & GEAR_OPEN:
        return best
    here = record(n, mode)
    edge = play_edge(d, s, mode, side)
    row, weight, sign = here + n[at.MESH], here + n[at.MESH_WEIGHT], side
    if not closed:
        overlap = side * dot(d, here + n[at.WINDUP], s, at.HEADER, 2 * n[at.BLOCKS]) + edge
        sign = -side
        if overlap <= 0.0:
            row, weight = here + n[at.WINDUP], here + n[at.WINDUP_WEIGHT]
    return look(
        d, n, mode, row, weight, sign, edge if closed else -edge, 0.0, 0.0,
        s, w, trial, force, size, start, end, best,
    )  # fmt: skip


@njit
def look_at_overlap(
    d: Numbers, n: Places, s: Numbers, mode: int, w: Numbers, trial: int, force: int, size: int,
    start: float, end: float, side: float, best: float,
) -> float:  # fmt: skip
    """Return when teeth that parted while they overlapped are clear of each other; else `best`."""
    if not mode & GEAR_OPEN:
        return best
    here = record(n, mode)
    edge = play_edge(d, s, mode, side)
    if side * dot(d, here + n[at.WINDUP], s, at.HEADER, 2 * n[at.BLOCKS]) + edge <= 0.0:
        return best
    return look(
        d, n, mode, here + n[at.WINDUP], here + n[at.WINDUP_WEIGHT], side, edge, 0.0, 0.0,
        s, w, trial, force, size, start, end, best,
    )  # fmt: skip


@njit(forceinline=True)
def next_event(
    d: Numbers, n: Places, s: Numbers, mode: int, command: float, w: Numbers, trial: int, force: int,
    coefficients: int, size: int, start: float, end: float,
) -> tuple[float, int, float]:  # fmt: skip
    """Return (time, kind, body or side) of the first event within (start, end]; kind NOTHING if there is none.

    If its time is not 0, the state then is left in w (see found_at).
    """
    here = record(n, mode)
    blocks = n[at.BLOCKS]
    amplitudes(d, here + n[at.C0], here + n[at.C1], blocks, s, w, force, n[at.VARYING], end, size)
    start_copy(blocks, s, w, force, size + 2 * blocks)
    best, kind, which = 2.0 * end + 1.0, NOTHING, 0.0
    for body in range(n[at.BODIES]):
        if not rubs(d, n, body):
            continue
        if not is_stuck(mode, body):
            row, weight = here + n[at.SPEED] + body * 2 * blocks, here + n[at.SPEED_WEIGHT] + body * blocks
            direction = s[at.HUB_DIRECTION + body]
            when = look(d, n, mode, row, weight, direction, 0.0, 0.0, 0.0, s, w, trial, force, size, start, end, best)
            if when < best:
                best, kind, which = when, STOP, float(body)
            continue
        row, weight = here + n[at.HOLD] + body * 2 * blocks, here + n[at.HOLD_WEIGHT] + body * blocks
        o0 = applied_offset(d, n, s, mode, body, command, w, coefficients, 0)
        o1 = applied_offset(d, n, s, mode, body, command, w, coefficients, 1) if n[at.VARYING] else 0.0
        o2 = applied_offset(d, n, s, mode, body, command, w, coefficients, 2) if n[at.VARYING] else 0.0
        load = load_now(d, n, s, mode)
        for side in range(2):
            push = 1.0 - 2.0 * side
            budget = static_budget(d, n, s, body, push, s[at.HELD_HUB + body], load)
            if start == 0.0 and push * (o0 + dot(d, row, s, at.HEADER, 2 * blocks)) > budget:
                return 0.0, BREAK, float(body)
            when = look(
                d, n, mode, row, weight, -push, budget - push * o0, -push * o1, -push * o2,
                s, w, trial, force, size, start, end, best,
            )  # fmt: skip
            if when < best:
                best, kind, which = when, BREAK, float(body)
    for side in range(2 if d[at.GAP] > 0.0 else 0):
        gear_side = 1.0 - 2.0 * side
        when = look_at_gears(d, n, s, mode, w, trial, force, size, start, end, gear_side, best)
        if when < best:
            best, kind, which = when, GEARS, gear_side
        when = look_at_overlap(d, n, s, mode, w, trial, force, size, start, end, gear_side, best)
        if when < best:
            best, kind, which = when, AGAIN, gear_side
    return best, kind, which
