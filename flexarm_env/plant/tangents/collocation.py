"""Derivatives of the forces of a step: those of the equations of its collocation, which are linear in them."""

from __future__ import annotations

import numpy as np
from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays
from flexarm_env.plant.event_free_table import NODES
from flexarm_env.plant.force_quartic import COEFFICIENTS
from flexarm_env.plant.modes import record
from flexarm_env.plant.tangents.bundles import KEY_LENGTH, KEY_MODE, KEY_ORDER, PER_TABLE, Tangent, TangentPlaces, argument_count
from flexarm_env.plant.tangents.laws import add_law_lanes, add_slope_lanes, write_arguments, write_slopes
from flexarm_env.plant.tangents.motion import block_rates, clear, move_lanes, start_lanes, write_force
from flexarm_env.plant.tangents.response import tabulate_responses

#: Coefficients of u and u² of the parabola through 0 at 0 and values at 1/2 and 1.
PARABOLA = np.array([[4.0, -1.0], [-4.0, 2.0]])
FACTORIALS = np.array([1.0, 1.0, 2.0, 6.0, 24.0])


@njit
def node_share(order: int, node: int) -> float:
    """Compute the time of a node as a share of the step."""
    return NODES[node] if order == 4 else 0.5 * (node + 1)


@njit
def node_weight(order: int, power: int, node: int) -> float:
    """Compute the coefficient of u^power by the value at a node, u being the share of the step."""
    return COEFFICIENTS[power - 1, node] if order == 4 else PARABOLA[power - 1, node]


@njit
def write_start(a: Arrays, g: Tangent, p: TangentPlaces, mode: int) -> None:
    """Write the derivatives of the forces at the start."""
    n, w = a.n, g.w
    count, time = n[at.BODIES] + n[at.POINTS], g.v[p.start + at.TIME]
    clear(w, p.lanes_coefficients, count)
    clear(w, p.lanes_event, 1)
    if n[at.VARYING]:
        start_lanes(a, g, p)
        write_arguments(a, g, p, mode, p.lanes_event)
        write_slopes(a, g, p, mode, time, 0)
        add_slope_lanes(a, g, p, 0, p.lanes_coefficients)
    else:
        for i in range(argument_count(n) - 4):
            g.v[p.motion + i] = 0.0
    add_law_lanes(a, g, p, mode, time, p.lanes_coefficients)


@njit
def write_shifts(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, order: int, node: int, table: int) -> None:
    """Write the change of each argument at a node by each coefficient of s^k/k! of each force, k = 1 to `order`."""
    d, n, v = a.d, a.n, g.v
    here, size, bodies, count = record(n, mode), 2 * n[at.BLOCKS], n[at.BODIES], n[at.BODIES] + n[at.POINTS]
    arguments = argument_count(n)
    first = p.shifts + node * arguments * order * count
    for i in range(arguments * order * count):
        v[first + i] = 0.0
    for q in range(arguments - 4):
        row = here + n[at.DRAG_VELOCITY] + (q - 2 * bodies) * size
        if q < bodies:
            row = here + n[at.ANGLE] + q * size
        elif q < 2 * bodies:
            row = here + n[at.SPEED] + (q - bodies) * size
        for k in range(n[at.BLOCKS]):
            u1, u2, c0, c1 = d[row + 2 * k], d[row + 2 * k + 1], d[here + n[at.C0] + k], d[here + n[at.C1] + k]
            if u1 == 0.0 and u2 == 0.0:
                continue
            for power in range(1, order + 1):
                i = table + PER_TABLE * k + 1 + power
                fast, slow = v[i], v[i + 1]
                by_first, by_second = u1 * (fast + c1 * slow) - u2 * c0 * slow, u1 * slow + u2 * fast
                for j in range(count):
                    column = here + n[at.FORCE_COLUMNS] + j * size + 2 * k
                    v[first + (q * order + power - 1) * count + j] += by_first * d[column] + by_second * d[column + 1]


@njit
def write_system(a: Arrays, g: Tangent, p: TangentPlaces, order: int, h: float) -> None:
    """Write the matrix of the equations of the forces' derivatives at the nodes."""
    n, v = a.n, g.v
    count, arguments = n[at.BODIES] + n[at.POINTS], argument_count(n)
    size = order * count
    for node in range(order):
        for i in range(count):
            row = p.system + (node * count + i) * size
            for j in range(size):
                v[row + j] = 1.0 if j == node * count + i else 0.0
            slopes = p.slopes + ((node + 1) * count + i) * arguments
            for q in range(arguments - 4):
                slope = v[slopes + q]
                if slope == 0.0:
                    continue
                for power in range(1, order + 1):
                    shift = p.shifts + ((node * arguments + q) * order + power - 1) * count
                    scale = slope * FACTORIALS[power] / h**power
                    for other in range(order):
                        weight = scale * node_weight(order, power, other)
                        for j in range(count):
                            v[row + other * count + j] -= weight * v[shift + j]


@njit
def solve_system(g: Tangent, p: TangentPlaces, size: int) -> None:
    """Solve the system for all lanes in place, by elimination with pivots."""
    v, w, lanes = g.v, g.w, g.w.shape[1]
    for i in range(size):
        best = i
        for j in range(i + 1, size):
            if abs(v[p.system + j * size + i]) > abs(v[p.system + best * size + i]):
                best = j
        if best != i:
            for j in range(size):
                one, two = p.system + i * size + j, p.system + best * size + j
                v[one], v[two] = v[two], v[one]
            for x in range(lanes):
                upper, lower = w[p.lanes_node + i, x], w[p.lanes_node + best, x]
                w[p.lanes_node + i, x], w[p.lanes_node + best, x] = lower, upper
        for j in range(i + 1, size):
            factor = v[p.system + j * size + i] / v[p.system + i * size + i]
            if factor == 0.0:
                continue
            for k in range(i, size):
                v[p.system + j * size + k] -= factor * v[p.system + i * size + k]
            for x in range(lanes):
                w[p.lanes_node + j, x] -= factor * w[p.lanes_node + i, x]
    for i in range(size - 1, -1, -1):
        for j in range(i + 1, size):
            factor = v[p.system + i * size + j]
            for x in range(lanes):
                w[p.lanes_node + i, x] -= factor * w[p.lanes_node + j, x]
        for x in range(lanes):
            w[p.lanes_node + i, x] /= v[p.system + i * size + i]


@njit
def fit_lanes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, command: float, order: int, h: float) -> None:
    """Write the force on the blocks over a step of h [s] and its derivatives, from the laws' forces in v.

    Row lanes_left of w has the derivatives of h. The tables at the nodes are left in v.
    """
    n, v, w, lanes = a.n, g.v, g.w, g.w.shape[1]
    count, size, time = n[at.BODIES] + n[at.POINTS], 2 * n[at.BLOCKS], v[p.start + at.TIME]
    write_start(a, g, p, mode)
    if order == 0:
        write_force(a, g, p, mode, command, 0)
        return
    for power in range(1, order + 1):
        total = 0.0
        for node in range(order):
            total += node_weight(order, power, node)
        total *= FACTORIALS[power] / h**power
        for j in range(count):
            out, own = p.lanes_coefficients + power * count + j, v[p.coefficients + power * count + j]
            for x in range(lanes):
                w[out, x] = -total * w[p.lanes_coefficients + j, x] - power * own / h * w[p.lanes_left, x]
    write_force(a, g, p, mode, command, order)
    clear(w, p.lanes_node, order * count)
    known = v[p.keys + KEY_MODE] == mode and v[p.keys + KEY_ORDER] == order and v[p.keys + KEY_LENGTH] == h
    v[p.keys + KEY_MODE], v[p.keys + KEY_ORDER], v[p.keys + KEY_LENGTH] = mode, order, h
    for node in range(order):
        share, table = node_share(order, node), p.tables + node * n[at.BLOCKS] * PER_TABLE
        if not known:
            tabulate_responses(a.d, n, mode, share * h, v, table)
            write_shifts(a, g, p, mode, order, node, table)
        move_lanes(a, g, p, mode, order, table)
        rates = p.tables + 4 * n[at.BLOCKS] * PER_TABLE  # the last table is not in use yet
        block_rates(a, g, p, mode, order, share * h, rates)
        for i in range(size):
            for x in range(lanes):
                w[p.lanes_z + i, x] += v[rates + i] * share * w[p.lanes_left, x]
        for x in range(lanes):
            w[p.lanes_event, x] = share * w[p.lanes_left, x]
        write_arguments(a, g, p, mode, p.lanes_event)
        write_slopes(a, g, p, mode, time + share * h, node + 1)
        add_slope_lanes(a, g, p, node + 1, p.lanes_node + node * count)
        add_law_lanes(a, g, p, mode, time + share * h, p.lanes_node + node * count)
    write_system(a, g, p, order, h)
    solve_system(g, p, order * count)
    for power in range(1, order + 1):
        for node in range(order):
            weight = node_weight(order, power, node) * FACTORIALS[power] / h**power
            for j in range(count):
                for x in range(lanes):
                    w[p.lanes_coefficients + power * count + j, x] += weight * w[p.lanes_node + node * count + j, x]
    write_force(a, g, p, mode, command, order)
