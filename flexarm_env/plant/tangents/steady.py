"""Derivatives over tabulated steps under a constant force, as nearly all are, in one pass over the blocks.

Over such a step the change of each block's derivatives is linear in its state, the command and 1. The factors of the first three
follow once for each mode; that of 1 holds the friction, and is kept until the mode or the direction changes.
"""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Places
from flexarm_env.plant.forces import apply_laws
from flexarm_env.plant.modes import record
from flexarm_env.plant.tangents.bundles import (
    KEY_DELAY,
    KEY_LENGTH,
    KEY_STEADY,
    MOST_ORDERS,
    PER_TABLE,
    Tangent,
    TangentPlaces,
    argument_count,
    mode_count,
)
from flexarm_env.plant.tangents.collocation import write_start
from flexarm_env.plant.tangents.laws import any_lane
from flexarm_env.plant.tangents.motion import block_rates, clear, move_lanes, write_force
from flexarm_env.plant.tangents.response import tabulate_responses


@njit(forceinline=True)
def is_steady(n: Places) -> bool:
    """Whether forces are constant between events, and the drive's output does not depend on the constants."""
    return n[at.STEADY_BODIES] > 0 and n[n[at.DRIVE_LAWS]] == 0 and n[n[at.RAMP_LAWS]] == 0


@njit
def write_steady_force(a: Arrays, g: Tangent, p: TangentPlaces, mode: int) -> None:
    """Write the forces of laws that do not depend on the motion to v."""
    n, v = a.n, g.v
    for i in range(argument_count(n) - 4):
        v[p.motion + i] = 0.0
    apply_laws(Arrays(a.d, n, v[p.start :], v), mode, v[p.start + at.TIME], p.motion, p.coefficients)


@njit(forceinline=True)
def steady_ones(n: Places, slot: int) -> int:
    """Locate the factors of 1 of a substep in `steady`."""
    return mode_count(n) * 3 * 2 * 2 * n[at.BLOCKS] + slot * 2 * n[at.BLOCKS]


@njit
def write_factor(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, slot: int, first: int, step: int) -> None:
    """Write the change of the blocks' derivatives over a substep, from the state at the start and the force, to rows of `steady`.

    The derivatives at the start count as zero; those of the substep's length do not.
    """
    n, v, w, gd, size = a.n, g.v, g.w, g.d, 2 * a.n[at.BLOCKS]
    rates = p.tables + MOST_ORDERS * n[at.BLOCKS] * PER_TABLE
    none = Tangent(gd, w[p.lanes_zero :], w, v, g.steady)
    move_lanes(a, none, p, mode, 0, p.steady_tables + (2 * mode + slot) * n[at.BLOCKS] * PER_TABLE)
    block_rates(a, g, p, mode, 0, 0.0, rates)
    for i in range(size):
        for x in range(w.shape[1]):
            g.steady[first + step * i, x] = w[p.lanes_z + i, x] + v[rates + i] * gd[at.EARLY_LENGTH + slot, x]


@njit
def prepare_steady(a: Arrays, g: Tangent, p: TangentPlaces) -> None:
    """Write the tables of all tabulated substeps, and the factors of state and command."""
    d, n, v, w = a.d, a.n, g.v, g.w
    size, count = 2 * n[at.BLOCKS], n[at.BODIES] + n[at.POINTS]
    for slot in range(2):
        v[p.keys + KEY_STEADY + slot] = -1.0
    v[p.keys + KEY_LENGTH] = -1.0
    v[p.keys + KEY_DELAY] = 1.0 if any_lane(g.d, at.EARLY_LENGTH) else 0.0
    for mode in range(mode_count(n)):
        for slot in range(2):
            length = d[at.EARLY_LENGTH + slot]
            tabulate_responses(d, n, mode, length, v, p.steady_tables + (2 * mode + slot) * n[at.BLOCKS] * PER_TABLE)
            if not is_steady(n):
                continue
            first = (2 * mode + slot) * size * 3
            for i in range(at.Z_START + size):
                v[p.start + i] = 0.0
            for i in range(count):
                v[p.coefficients + i] = 0.0
            clear(w, p.lanes_coefficients, count)
            clear(w, p.lanes_command, 1)
            for half in range(2):
                for i in range(size):
                    v[p.phi + i] = 0.0
                    v[p.start + at.Z_START + i] = 1.0 if i % 2 == half else 0.0
                clear(w, p.lanes_force, size)
                write_factor(a, g, p, mode, slot, first + half, 3)
            for i in range(size):
                v[p.start + at.Z_START + i] = 0.0
            write_force(a, g, p, mode, 0.0, 0)
            write_factor(a, g, p, mode, slot, steady_ones(n, slot), 1)
            write_force(a, g, p, mode, 1.0, 0)
            write_factor(a, g, p, mode, slot, first + 2, 3)
            for i in range(size):
                for x in range(w.shape[1]):
                    g.steady[first + 2 + 3 * i, x] -= g.steady[steady_ones(n, slot) + i, x]


@njit(forceinline=True)
def forget_ones(g: Tangent, p: TangentPlaces) -> None:
    """Have the factors of 1 written anew: a held angle, which acts on the blocks, has changed."""
    for slot in range(2):
        g.v[p.keys + KEY_STEADY + slot] = -1.0


@njit
def write_ones(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, slot: int) -> None:
    """Write the factors of 1: of friction, constant torque, gears and held angles."""
    n, v, w, size = a.n, g.v, g.w, 2 * a.n[at.BLOCKS]
    write_steady_force(a, g, p, mode)
    write_start(a, g, p, mode)
    clear(w, p.lanes_command, 1)
    write_force(a, g, p, mode, 0.0, 0)
    for i in range(size):
        v[p.shifts + i] = v[p.start + at.Z_START + i]
        v[p.start + at.Z_START + i] = 0.0
    write_factor(a, g, p, mode, slot, steady_ones(n, slot), 1)
    for i in range(size):
        v[p.start + at.Z_START + i] = v[p.shifts + i]


@njit(forceinline=True)
def steady_lanes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, command: float, slot: int) -> None:
    """Carry the derivatives over a tabulated substep under a constant force."""
    d, n, v, w, gs, steady = a.d, a.n, g.v, g.w, g.s, g.steady
    directions = v[p.start + at.HUB_DIRECTION] + 3.0 * v[p.start + at.MOTOR_DIRECTION] + 9.0 * v[p.start + at.GEAR_SIDE]
    key = mode + 8.0 * (directions + 20.0)
    if v[p.keys + KEY_STEADY + slot] != key:
        write_ones(a, g, p, mode, slot)
        v[p.keys + KEY_STEADY + slot] = key
    here, size, lanes = record(n, mode), 2 * n[at.BLOCKS], w.shape[1]
    factor, one = (2 * mode + slot) * size * 3, steady_ones(n, slot)
    for k in range(n[at.BLOCKS]):
        i = p.steady_tables + ((2 * mode + slot) * n[at.BLOCKS] + k) * PER_TABLE
        c, s, c0, c1 = v[i], v[i + 1], d[here + n[at.C0] + k], d[here + n[at.C1] + k]
        qp, qq = -c0 * s, c - c1 * s
        z, out, f = at.Z_START + 2 * k, p.lanes_z, factor + 6 * k
        y, q = v[p.start + z], v[p.start + z + 1]
        for x in range(lanes):
            moved = c * gs[z, x] + s * gs[z + 1, x] + steady[f, x] * y
            w[out, x] = moved + steady[f + 1, x] * q + steady[f + 2, x] * command + steady[one + 2 * k, x]
        for x in range(lanes):
            moved = qp * gs[z, x] + qq * gs[z + 1, x] + steady[f + 3, x] * y
            gs[z + 1, x] = moved + steady[f + 4, x] * q + steady[f + 5, x] * command + steady[one + 2 * k + 1, x]
        for x in range(lanes):
            gs[z, x] = w[out, x]
