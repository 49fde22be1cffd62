"""Tables of an event-free step: the blocks' responses, and the motion of each quantity that enters a law.

Few quantities enter the laws, so a sweep takes few sums: tables give the motion of each quantity under constant forces, and its
change by each coefficient of the forces' change.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.crossing import chord_error
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.propagate import INVERSE_FACTORIALS

#: Lobatto's nodes after the start; the change of force over a step is a polynomial of this order.
NODES = np.array([0.5 - math.sqrt(3.0 / 28.0), 0.5, 0.5 + math.sqrt(3.0 / 28.0), 1.0])
ORDER = 4
#: Largest number of times that a step is halved.
DEPTH = 3
#: Terms of the series of a short time, and the |c₀| t² + |c₁| t up to which it is one.
TERMS, LONG_ARGUMENT = 12, 0.125
#: Numbers of a block in a table: C, S, R₀, chord error, each for all blocks.
PER_BLOCK = 4


@njit
def long_response(c0: float, c1: float, t: float, r: Numbers, first: int) -> None:
    """Write C, S, R₀ to R₄ of one block after time t [s] to r: block_response to higher orders."""
    doublings = 0
    while abs(c0) * t * t + abs(c1) * t > LONG_ARGUMENT:
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
    r[first], r[first + 1], r[first + 2], r[first + 3], r[first + 4], r[first + 5], r[first + 6] = c, s, r0, r1, r2, r3, r4


class StepTable(NamedTuple):
    """Table of an event-free step: its array and the places in it of its parts.

    `responses`: C, S, R₀, chord error of each block. `bends`: chord error of each tested row per variation of the force on each
    body. `work`: room for one response. If forces vary, for each node and quantity (angles, then speeds), `rows`: its row on z at
    the start, `drives`: its change by each driver, `shifts`: its change by each coefficient of the forces' change. `ends`: by
    block, the change of z at the end by these coefficients.
    """

    data: Numbers
    responses: int
    bends: int
    work: int
    rows: int
    drives: int
    shifts: int
    ends: int


@njit
def table_size(n: Places) -> int:
    """Count the numbers of the table of a step (see StepTable)."""
    blocks, bodies = n[at.BLOCKS], n[at.BODIES]
    size = PER_BLOCK * blocks + (bodies + 1) * bodies + 7
    if n[at.VARYING]:
        nodes = ORDER * 2 * bodies  # of each quantity
        size += nodes * (2 * blocks + n[at.DRIVERS] + ORDER * bodies) + 2 * ORDER * bodies * blocks
    return size


@njit(forceinline=True)
def step_table(n: Places, data: Numbers, first: int) -> StepTable:
    """Lay out the table of a step that starts at `first`."""
    blocks, bodies = n[at.BLOCKS], n[at.BODIES]
    bends = first + PER_BLOCK * blocks
    work = bends + (bodies + 1) * bodies
    rows = work + 7
    drives = rows + ORDER * 2 * bodies * 2 * blocks
    shifts = drives + ORDER * 2 * bodies * n[at.DRIVERS]
    ends = shifts + ORDER * 2 * bodies * ORDER * bodies
    return StepTable(data, first, bends, work, rows, drives, shifts, ends)


@njit
def has_step_tables(n: Places) -> bool:
    """Whether the arm has tables of event-free steps: a quiet step does not cover it, and no drag varies along the beam."""
    return n[at.POINTS] == 0 and (n[at.VARYING] > 0 or n[at.BODIES] == 2)


@njit(forceinline=True)
def tabulated_step(d: Numbers, n: Places, mode: int, slot: int, level: int) -> StepTable:
    """Locate the table in d of a substep that is halved `level` times."""
    level += slot * (DEPTH + 1 if n[at.VARYING] else 1)
    return step_table(n, d, record(n, mode) + n[at.STEP_TABLES] + level * table_size(n))


@njit
def tested_row(n: Places, mode: int, row: int) -> tuple[int, int]:
    """Locate the row that is tested for a body's event, or (last) for the gears', and its weights."""
    here, blocks = record(n, mode), n[at.BLOCKS]
    if row == n[at.BODIES]:
        return here + n[at.MESH], here + n[at.MESH_WEIGHT]
    if is_stuck(mode, row):
        return here + n[at.HOLD] + row * 2 * blocks, here + n[at.HOLD_WEIGHT] + row * blocks
    return here + n[at.SPEED] + row * 2 * blocks, here + n[at.SPEED_WEIGHT] + row * blocks


@njit
def bend_by_force(d: Numbers, n: Places, mode: int, row: int, body: int, length: float) -> float:
    """Bound the chord error of a tested row per variation of the force on a body."""
    here, blocks = record(n, mode), n[at.BLOCKS]
    place, weight = tested_row(n, mode, row)
    column = here + n[at.FORCE_COLUMNS] + body * 2 * blocks
    total = 0.0
    for k in range(blocks):
        a, b = d[here + n[at.C0] + k], d[here + n[at.C1] + k]
        f, g = abs(d[column + 2 * k]), abs(d[column + 2 * k + 1])
        growth = math.exp(max(-b, 0.0) * length)
        total += d[weight + k] * 0.125 * length * length * growth * (math.sqrt(a) * f + g)
        total += 0.125 * length * (abs(d[place + 2 * k]) * f + abs(d[place + 2 * k + 1]) * g)
    return total


@njit(forceinline=True)
def tabulate_quantities(d: Numbers, n: Places, mode: int, k: int, node: int, length: float, table: StepTable) -> None:
    """Add the part of block k in each quantity at a node of a step, from the block's response there."""
    here, blocks, bodies, drivers, to = record(n, mode), n[at.BLOCKS], n[at.BODIES], n[at.DRIVERS], table.data
    size, quantities = 2 * blocks, 2 * bodies
    c0, c1 = d[here + n[at.C0] + k], d[here + n[at.C1] + k]
    forcing = here + n[at.FORCING] + 2 * k
    c, s = to[table.work], to[table.work + 1]
    for q in range(quantities):
        place = n[at.ANGLE] + q * size if q < bodies else n[at.SPEED] + (q - bodies) * size
        u, v = d[here + place + 2 * k], d[here + place + 2 * k + 1]
        i = node * quantities + q
        row = table.rows + i * size + 2 * k
        if u == 0.0 and v == 0.0:
            to[row] = to[row + 1] = 0.0
            continue
        to[row] = u * c - v * c0 * s
        to[row + 1] = u * s + v * (c - c1 * s)
        faster, slower = s, to[table.work + 2]
        by_first, by_second = u * (faster + c1 * slower) - v * c0 * slower, u * slower + v * faster
        for j in range(drivers):
            f, g = d[forcing + j * size], d[forcing + j * size + 1]
            to[table.drives + i * drivers + j] += by_first * f + by_second * g
        scale = 1.0
        for order in range(ORDER):
            scale *= (order + 1) / length
            faster, slower = to[table.work + 2 + order], to[table.work + 3 + order]
            by_first, by_second = u * (faster + c1 * slower) - v * c0 * slower, u * slower + v * faster
            for body in range(bodies):
                column = forcing + (at.W_HUB + body) * size
                f, g = d[column], d[column + 1]
                to[table.shifts + (i * bodies + body) * ORDER + order] += scale * (by_first * f + by_second * g)


@njit(forceinline=True)
def tabulate_end(d: Numbers, n: Places, mode: int, k: int, length: float, table: StepTable) -> None:
    """Write the change of block k at the end of a step by each coefficient of the forces' change."""
    here, bodies, to = record(n, mode), n[at.BODIES], table.data
    c0, c1 = d[here + n[at.C0] + k], d[here + n[at.C1] + k]
    for body in range(bodies):
        column = here + n[at.FORCING] + (at.W_HUB + body) * 2 * n[at.BLOCKS] + 2 * k
        f, g = d[column], d[column + 1]
        scale = 1.0
        for order in range(ORDER):
            scale *= (order + 1) / length
            faster, slower = to[table.work + 2 + order], to[table.work + 3 + order]
            i = table.ends + (body * ORDER + order) * 2 * n[at.BLOCKS] + 2 * k
            to[i] = scale * (f * (faster + c1 * slower) + g * slower)
            to[i + 1] = scale * (g * faster - c0 * slower * f)


@njit
def prepare_step_table(d: Numbers, n: Places, mode: int, length: float, table: StepTable) -> None:
    """Write the table of a step of a given length [s] (see StepTable)."""
    here, blocks, bodies, to = record(n, mode), n[at.BLOCKS], n[at.BODIES], table.data
    for row in range(bodies + 1):
        for body in range(bodies):
            to[table.bends + row * bodies + body] = bend_by_force(d, n, mode, row, body, length)
    if n[at.VARYING]:
        for i in range(table.drives, table.ends):
            to[i] = 0.0
    for k in range(blocks):
        c0, c1 = d[here + n[at.C0] + k], d[here + n[at.C1] + k]
        for node in range(0 if n[at.VARYING] else ORDER - 1, ORDER):
            long_response(c0, c1, NODES[node] * length, to, table.work)
            if n[at.VARYING]:
                tabulate_quantities(d, n, mode, k, node, length, table)
        i = table.responses + k
        to[i], to[i + blocks] = to[table.work], to[table.work + 1]
        to[i + 2 * blocks], to[i + 3 * blocks] = to[table.work + 2], chord_error(c0, c1, length)
        if n[at.VARYING]:
            tabulate_end(d, n, mode, k, length, table)
