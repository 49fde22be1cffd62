"""The quiet step: a whole tabulated substep without events, as nearly all are, in one pass over the blocks."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Numbers, Places, Segment
from flexarm_env.plant.crossing import chord_error
from flexarm_env.plant.event_free_table import DEPTH, has_step_tables, prepare_step_table, tabulated_step
from flexarm_env.plant.force_parabola import force_influence, influence_size
from flexarm_env.plant.forces import effect_torque
from flexarm_env.plant.friction import Contact, friction_budget
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.propagate import RESPONSE, respond
from flexarm_env.plant.stick_slip import has_friction


@njit
def prepare_quiet_step(d: Numbers, n: Places, mode: int, length: float, table: int, place: int) -> None:
    """Write the table of a quiet step from `place` on."""
    here = record(n, mode)
    row, weight = here + n[at.SPEED], here + n[at.SPEED_WEIGHT]
    if is_stuck(mode, 0):
        row, weight = here + n[at.HOLD], here + n[at.HOLD_WEIGHT]
    for k in range(n[at.BLOCKS]):
        a, b = d[here + n[at.C0] + k], d[here + n[at.C1] + k]
        c, s, r0 = d[table + k], d[table + n[at.BLOCKS] + k], d[table + 2 * n[at.BLOCKS] + k]
        d[place + at.Q_C], d[place + at.Q_S], d[place + at.Q_R0], d[place + at.Q_S_R0] = c, s, r0, s + b * r0
        d[place + at.Q_C0], d[place + at.Q_C1] = a, b
        d[place + at.Q_BEND] = d[weight + k] * chord_error(a, b, length)
        for half in range(2):
            d[place + at.Q_ROW + half] = d[row + 2 * k + half]
            by, size = here + n[at.FORCING] + 2 * k + half, 2 * n[at.BLOCKS]
            d[place + at.Q_COMMAND + half], d[place + at.Q_HUB + half] = d[by + at.W_COMMAND * size], d[by + at.W_HUB * size]
            d[place + at.Q_ONE + half], d[place + at.Q_HELD + half] = d[by + at.W_ONE * size], d[by + at.W_HELD_HUB * size]
        place += at.QUIET_SIZE


@njit
def prepare(d: Numbers, n: Places) -> None:
    """Write the tables of d that follow from its modes and the lengths of its substeps."""
    blocks = n[at.BLOCKS]
    for mode in range((n[at.PARAMETERS] - n[at.MODES]) // n[at.STRIDE]):
        here = n[at.MODES] + mode * n[at.STRIDE]
        for slot in range(2):
            length, table = d[at.EARLY_LENGTH + slot], here + n[at.RESPONSES] + 2 * slot * RESPONSE * blocks
            respond(d, here + n[at.C0], here + n[at.C1], blocks, 0.5 * length, d, table)
            respond(d, here + n[at.C0], here + n[at.C1], blocks, length, d, table + RESPONSE * blocks)
            if n[at.VARYING] and n[at.POINTS]:
                for half in range(2):
                    place = here + n[at.STEP_TABLES] + (2 * slot + half) * influence_size(n)
                    force_influence(d, n, mode, Segment(d, table + half * RESPONSE * blocks), Segment(d, place))
            if has_step_tables(n) and length > 0.0:
                for level in range(DEPTH + 1 if n[at.VARYING] else 1):
                    prepare_step_table(d, n, mode, length * 0.5**level, tabulated_step(d, n, mode, slot, level))
            prepare_quiet_step(
                d, n, mode, length, table + RESPONSE * blocks, here + n[at.QUIET_TABLE] + slot * blocks * at.QUIET_SIZE
            )


@njit(forceinline=True)
def limits(a: Arrays, here: int, stuck: bool, command: float, torque: float) -> tuple[float, float, float, float]:
    """Compute (torque on the hub, offset, low, high): no event while the row on z plus offset stays between the two.

    A held hub stays so at the limits too, as one without a push where friction at rest is 0.
    """
    d, n, s = a.d, a.n, a.s
    direction, held, time = s[at.HUB_DIRECTION], s[at.HELD_HUB], s[at.TIME]
    if stuck:
        row = here + n[at.HOLD_DRIVERS]
        offset = d[row + at.W_COMMAND] * command + d[row + at.W_HUB] * torque + d[row + at.W_ONE] + d[row + at.W_HELD_HUB] * held
        low = -friction_budget(d, n, 0, Contact(-1.0, 0.0, held, time, 0.0, True))
        return torque, offset, low, friction_budget(d, n, 0, Contact(1.0, 0.0, held, time, 0.0, True))
    if not has_friction(d, n, 0):
        return torque, 0.0, -math.inf, math.inf
    torque -= direction * friction_budget(d, n, 0, Contact(direction, 0.0, held, time, 0.0, False))
    return torque, 0.0, 0.0 if direction > 0.0 else -math.inf, math.inf if direction > 0.0 else 0.0


@njit(forceinline=True)
def quiet_step(a: Arrays, command: float, length: float, slot: int) -> bool:
    """Advance the arm by a whole tabulated substep and return True, if certainly no event falls in it.

    x = ż = (q + f₁, f₂ − c₀ p − c₁ q) moves as z does without a force, and its size bounds the chord error of the row
    that is tested for events.
    """
    d, n, s, w = a.d, a.n, a.s, a.w
    mode = int(s[at.MODE]) & 1
    here = record(n, mode)
    torque = effect_torque(d, n, 0, 0.0, 0.0, s[at.TIME])
    torque, offset, low, high = limits(a, here, mode == 1, command, torque)
    held = s[at.HELD_HUB]
    before, after, bend = offset, offset, 0.0
    place = here + n[at.QUIET_TABLE] + slot * n[at.BLOCKS] * at.QUIET_SIZE
    for k in range(n[at.BLOCKS]):
        f1 = d[place + at.Q_COMMAND] * command + d[place + at.Q_HUB] * torque
        f2 = d[place + at.Q_COMMAND + 1] * command + d[place + at.Q_HUB + 1] * torque
        f1, f2 = (
            f1 + (d[place + at.Q_ONE] + d[place + at.Q_HELD] * held),
            f2 + (d[place + at.Q_ONE + 1] + d[place + at.Q_HELD + 1] * held),
        )
        p, q = s[at.Z_START + 2 * k], s[at.Z_START + 2 * k + 1]
        c0, u, v = d[place + at.Q_C0], d[place + at.Q_ROW], d[place + at.Q_ROW + 1]
        x, y = q + f1, f2 - c0 * p - d[place + at.Q_C1] * q
        new_p = p + d[place + at.Q_S_R0] * x + d[place + at.Q_R0] * y
        new_q = d[place + at.Q_C] * x + d[place + at.Q_S] * y - f1
        before += u * p + v * q
        after += u * new_p + v * new_q
        bend += d[place + at.Q_BEND] * math.sqrt(c0 * x * x + y * y)
        w[2 * k], w[2 * k + 1] = new_p, new_q
        place += at.QUIET_SIZE
    least, most = min(before, after) - bend, max(before, after) + bend
    if not (low <= least and most <= high if mode == 1 else low < least and most < high):
        return False
    for i in range(2 * n[at.BLOCKS]):
        s[at.Z_START + i] = w[i]
    s[at.TIME] += length
    return True
