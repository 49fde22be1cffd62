"""The short cut: a whole step in which nothing happens, which is nearly every step, in one pass over the blocks."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant.crossing import stray
from flexarm_env.plant.layout import (
    BLOCKS,
    BODIES,
    C0,
    C1,
    DRIVERS,
    EARLY_LENGTH,
    FORCING,
    G_BEND,
    G_C,
    G_C0,
    G_C1,
    G_COMMAND,
    G_HELD,
    G_HUB,
    G_ONE,
    G_R0,
    G_ROW,
    G_S,
    G_S_R0,
    GLIDE,
    GLIDE_SIZE,
    HEADER,
    HELD_HUB,
    HOLD,
    HOLD_DRIVERS,
    HOLD_WEIGHT,
    HUB_DIRECTION,
    MODE,
    MODES,
    PARAMETERS,
    POINTS,
    REACH,
    RESPONSES,
    SPEED,
    SPEED_WEIGHT,
    STRIDE,
    TIME,
    VARYING,
    W_COMMAND,
    W_HELD_HUB,
    W_HUB,
    W_ONE,
    Numbers,
    Places,
)
from flexarm_env.plant.propagate import RESPONSE, respond
from flexarm_env.plant.slide_table import DEPTH, prepare_slide, slide_table, slides
from flexarm_env.plant.stick_slip import effect_torque, friction_budget, is_stuck, record, rubs
from flexarm_env.plant.varying import reach


@njit
def prepare_glide(d: Numbers, n: Places, mode: int, length: float, table: int, at: int) -> None:
    """Gather the table of a substep without events from `at` on."""
    here = record(n, mode)
    row, weight = here + n[SPEED], here + n[SPEED_WEIGHT]
    if is_stuck(mode, 0):
        row, weight = here + n[HOLD], here + n[HOLD_WEIGHT]
    for k in range(n[BLOCKS]):
        a, b = d[here + n[C0] + k], d[here + n[C1] + k]
        i = table + RESPONSE * k
        d[at + G_C], d[at + G_S], d[at + G_R0], d[at + G_S_R0] = d[i], d[i + 1], d[i + 2], d[i + 1] + b * d[i + 2]
        d[at + G_C0], d[at + G_C1] = a, b
        d[at + G_BEND] = d[weight + k] * stray(a, b, length)
        for half in range(2):
            d[at + G_ROW + half] = d[row + 2 * k + half]
            forcing = here + n[FORCING] + (2 * k + half) * n[DRIVERS]
            d[at + G_COMMAND + half], d[at + G_HUB + half] = d[forcing + W_COMMAND], d[forcing + W_HUB]
            d[at + G_ONE + half], d[at + G_HELD + half] = d[forcing + W_ONE], d[forcing + W_HELD_HUB]
        at += GLIDE_SIZE


@njit
def prepare(d: Numbers, n: Places) -> None:
    """Fill in the tables of d that follow from its modes and the lengths of its substeps."""
    blocks = n[BLOCKS]
    for mode in range((n[PARAMETERS] - n[MODES]) // n[STRIDE]):
        here = n[MODES] + mode * n[STRIDE]
        for slot in range(2):
            length, table = d[EARLY_LENGTH + slot], here + n[RESPONSES] + 2 * slot * RESPONSE * blocks
            respond(d, here + n[C0], here + n[C1], blocks, 0.5 * length, d, table)
            respond(d, here + n[C0], here + n[C1], blocks, length, d, table + RESPONSE * blocks)
            if n[VARYING] and n[POINTS]:
                size = (2 * n[BODIES] + n[POINTS]) * 3 * (n[BODIES] + n[POINTS])
                for half in range(2):
                    place = here + n[REACH] + (2 * slot + half) * size
                    reach(d, n, mode, d, table + half * RESPONSE * blocks, d, place)
            if slides(n) and length > 0.0:
                for level in range(DEPTH + 1 if n[VARYING] else 1):
                    prepare_slide(d, n, mode, length * 0.5**level, d, slide_table(n, mode, slot, level))
            prepare_glide(d, n, mode, length, table + RESPONSE * blocks, here + n[GLIDE] + slot * blocks * GLIDE_SIZE)


@njit(forceinline=True)
def limits(
    d: Numbers, n: Places, s: Numbers, here: int, stuck: bool, command: float, torque: float
) -> tuple[float, float, float, float]:
    """Return (torque on the hub, offset, low, high): no event while the row on z plus offset stays between the two."""
    direction, held = s[HUB_DIRECTION], s[HELD_HUB]
    if stuck:
        row = here + n[HOLD_DRIVERS]
        offset = d[row + W_COMMAND] * command + d[row + W_HUB] * torque + d[row + W_ONE] + d[row + W_HELD_HUB] * held
        low = -friction_budget(d, n, 0, -1.0, 0.0, held, s[TIME], 0.0, True)
        return torque, offset, low, friction_budget(d, n, 0, 1.0, 0.0, held, s[TIME], 0.0, True)
    if not rubs(d, n, 0):
        return torque, 0.0, -math.inf, math.inf
    torque -= direction * friction_budget(d, n, 0, direction, 0.0, held, s[TIME], 0.0, False)
    return torque, 0.0, 0.0 if direction > 0.0 else -math.inf, math.inf if direction > 0.0 else 0.0


@njit(forceinline=True)
def glide(d: Numbers, n: Places, s: Numbers, command: float, length: float, slot: int, w: Numbers) -> bool:
    """Move the arm on by a whole tabulated substep and return True, if it is sure that no event falls in it.

    x = ż = (q + f₁, f₂ − c₀ p − c₁ q) moves as z would without a force, and its size bounds how far the row that
    tells of events strays from its chord.
    """
    mode = int(s[MODE]) & 1
    here = record(n, mode)
    torque = effect_torque(d, n, 0, 0.0, 0.0, s[TIME])
    torque, offset, low, high = limits(d, n, s, here, mode == 1, command, torque)
    held = s[HELD_HUB]
    before, after, bend = offset, offset, 0.0
    at = here + n[GLIDE] + slot * n[BLOCKS] * GLIDE_SIZE
    for k in range(n[BLOCKS]):
        f1 = d[at + G_COMMAND] * command + d[at + G_HUB] * torque
        f2 = d[at + G_COMMAND + 1] * command + d[at + G_HUB + 1] * torque
        f1, f2 = f1 + (d[at + G_ONE] + d[at + G_HELD] * held), f2 + (d[at + G_ONE + 1] + d[at + G_HELD + 1] * held)
        p, q = s[HEADER + 2 * k], s[HEADER + 2 * k + 1]
        a, u, v = d[at + G_C0], d[at + G_ROW], d[at + G_ROW + 1]
        x, y = q + f1, f2 - a * p - d[at + G_C1] * q
        new_p = p + d[at + G_S_R0] * x + d[at + G_R0] * y
        new_q = d[at + G_C] * x + d[at + G_S] * y - f1
        before += u * p + v * q
        after += u * new_p + v * new_q
        bend += d[at + G_BEND] * math.sqrt(a * x * x + y * y)
        w[2 * k], w[2 * k + 1] = new_p, new_q
        at += GLIDE_SIZE
    if min(before, after) - bend <= low or max(before, after) + bend >= high:
        return False
    for i in range(2 * n[BLOCKS]):
        s[HEADER + i] = w[i]
    s[TIME] += length
    return True
