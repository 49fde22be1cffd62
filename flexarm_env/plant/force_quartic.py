"""Forces that vary with the motion over an event-free step: quartics in time.

Each force is the quartic through its values at five Lobatto nodes of the motion that the forces cause: exponential
collocation of order eight (Hochbruck and Ostermann, Exponential integrators, Acta Numerica 2010, section 2.2).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Numbers, Places
from flexarm_env.plant.event_free_table import NODES, ORDER, StepTable
from flexarm_env.plant.forces import apply_laws
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.modes import record

#: Coefficients of u to u⁴ from the values at the nodes of a quartic that is 0 at u = 0.
COEFFICIENTS = np.ascontiguousarray(np.linalg.inv(np.power.outer(NODES, np.arange(1, 5))))
MOST_SWEEPS = 8
#: Largest change by further sweeps, and largest coefficient of u⁴ in a step that is not halved; both as a share of the force.
SWEEP_TOLERANCE, QUARTIC_TOLERANCE = 1e-8, 2e-2
#: Slowest convergence, as the ratio of successive sweeps' changes, before a step is halved.
SLOW = 0.3


class StepScratch(NamedTuple):
    """Places in w during a step without events, behind the new state at 0.

    `bends`: bound of each block's chord error. `block_forces`: the forces on the blocks at the start. `inputs`: the drivers.
    `start`, `forces`: motion and forces on the bodies at the start.
    `changes`: the coefficients of the forces' change. For the fit of these: `motion` at a node, the forces there (`new`),
    their `values` at all nodes, the motion without the forces' change (`free`).
    """

    bends: int
    block_forces: int
    inputs: int
    start: int
    forces: int
    changes: int
    motion: int
    new: int
    values: int
    free: int


@njit(forceinline=True)
def step_places(n: Places) -> StepScratch:
    """Lay out the scratch of a step without events."""
    blocks, bodies = n[at.BLOCKS], n[at.BODIES]
    bends = 2 * blocks
    block_forces = bends + blocks
    inputs = block_forces + 2 * blocks
    start = inputs + n[at.DRIVERS]
    forces = start + 2 * bodies
    changes = forces + bodies
    motion = changes + ORDER * bodies
    new = motion + 2 * bodies
    values = new + bodies
    return StepScratch(bends, block_forces, inputs, start, forces, changes, motion, new, values, values + ORDER * bodies)


@njit
def step_scratch(n: Places) -> int:
    """Count the numbers of scratch of a step without events."""
    return step_places(n).free + ORDER * 2 * n[at.BODIES]


@njit(forceinline=True)
def move_freely(a: Arrays, table: StepTable, places: StepScratch) -> None:
    """Write each quantity at each node of the motion under constant drivers."""
    d, n, s, w = a.d, a.n, a.s, a.w
    bodies, drivers, size = n[at.BODIES], n[at.DRIVERS], 2 * n[at.BLOCKS]
    holds = record(n, int(s[at.MODE])) + n[at.HOLDS_ANGLE]
    for i in range(ORDER * 2 * bodies):
        total = inner_product(table.data, table.rows + i * size, s, at.Z_START, size)
        total += inner_product(table.data, table.drives + i * drivers, w, places.inputs, drivers)
        q = i % (2 * bodies)
        if q < bodies:
            total += d[holds + q] * s[at.HELD_HUB + q]
        w[places.free + i] = total


@njit(forceinline=True)
def sweep_nodes(a: Arrays, length: float, table: StepTable, places: StepScratch) -> float:
    """Evaluate the forces at the nodes of the motion that they cause; return their largest change since the last sweep."""
    s, w, bodies = a.s, a.w, a.n[at.BODIES]
    mode = int(s[at.MODE])
    change = 0.0
    for node in range(ORDER):
        for q in range(2 * bodies):
            i = node * 2 * bodies + q
            moved = inner_product(table.data, table.shifts + i * bodies * ORDER, w, places.changes, bodies * ORDER)
            w[places.motion + q] = w[places.free + i] + moved
        apply_laws(a, mode, s[at.TIME] + NODES[node] * length, places.motion, places.new)
        for body in range(bodies):
            value = w[places.new + body] - w[places.forces + body]
            change = max(change, abs(value - w[places.values + body * ORDER + node]))
            w[places.values + body * ORDER + node] = value
    for body in range(bodies):
        for order in range(ORDER):
            total = 0.0
            for node in range(ORDER):
                total += COEFFICIENTS[order, node] * w[places.values + body * ORDER + node]
            w[places.changes + body * ORDER + order] = total
    return change


@njit
def fit_quartic(a: Arrays, length: float, last: bool, table: StepTable, places: StepScratch) -> bool:
    """Fit the change of the forces over the step: coefficients of u to u⁴, by body, to w at `changes`.

    Return whether the sweeps converge and the coefficient of u⁴ is small. With `last` the step cannot be halved.
    """
    w, bodies = a.w, a.n[at.BODIES]
    move_freely(a, table, places)
    for i in range(ORDER * bodies):
        w[places.values + i] = w[places.changes + i] = 0.0
    scale = 0.0
    for body in range(bodies):
        scale += abs(w[places.forces + body])
    before = 1.0
    for sweep in range(MOST_SWEEPS):
        change = sweep_nodes(a, length, table, places)
        if change * min(change / before, 1.0) <= SWEEP_TOLERANCE * scale:
            quartic = 0.0
            for body in range(bodies):
                quartic = max(quartic, abs(w[places.changes + body * ORDER + ORDER - 1]))
            return quartic <= QUARTIC_TOLERANCE * scale
        if sweep > 0 and change > SLOW * before and not last:
            return False
        before = change
    return False


@njit
def variation(w: Numbers, changes: int) -> float:
    """Bound the variation of a force over the step."""
    total = 0.0
    for order in range(ORDER):
        total += (order + 1) * abs(w[changes + order])
    return total
