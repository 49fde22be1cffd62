"""Forces that vary with the motion, over a step without events.

The force is the quartic in time through its values at five Lobatto nodes of the motion that it causes: exponential
collocation of order eight (Hochbruck and Ostermann, Exponential integrators, Acta Numerica 2010, section 2.2).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.propagate import dot, inlined_dot
from flexarm_env.plant.slide_table import NODES, ORDER
from flexarm_env.plant.stick_slip import apply_laws, record

#: Coefficients of u to u⁴ from the values at the nodes of what is 0 at u = 0.
COEFFICIENTS = np.ascontiguousarray(np.linalg.inv(np.power.outer(NODES, np.arange(1, 5))))
MOST_SWEEPS = 8
#: Over the force: what further sweeps may change, and the largest coefficient of the quartic part that a step may have.
SWEEP_TOLERANCE, QUARTIC_TOLERANCE = 1e-8, 2e-2
#: Sweeps that change the force by more than this share of what the one before did are given up, if the step can be halved.
SLOW = 0.3


@njit
def fit_force(
    d: Numbers, n: Places, s: Numbers, mode: int, length: float, last: bool, tab: Numbers, rows: int, w: Numbers,
    inputs: int, start: int, changes: int,
) -> bool:  # fmt: skip
    """Find how the forces change over the step: coefficients of u to u⁴, by body, to w at `changes`.

    `inputs` are the drivers, `start` the motion and after it the forces at the start. Return whether the sweeps
    converge and the quartic is small.
    """
    blocks, bodies, drivers = n[at.BLOCKS], n[at.BODIES], n[at.DRIVERS]
    size, quantities = 2 * blocks, 2 * bodies
    here = record(n, mode)
    drives = rows + ORDER * quantities * size
    shifts = drives + ORDER * quantities * drivers
    forces = start + quantities
    motion = changes + ORDER * bodies
    new = motion + quantities
    values = new + bodies
    free = values + ORDER * bodies
    for i in range(ORDER * quantities):
        total = inlined_dot(tab, rows + i * size, s, at.HEADER, size)
        for j in range(drivers):
            total += tab[drives + i * drivers + j] * w[inputs + j]
        q = i % quantities
        if q < bodies:
            total += d[here + n[at.HOLDS_ANGLE] + q] * s[at.HELD_HUB + q]
        w[free + i] = total
    for i in range(ORDER * bodies):
        w[values + i] = w[changes + i] = 0.0
    scale = 0.0
    for body in range(bodies):
        scale += abs(w[forces + body])
    before = 1.0
    for sweep in range(MOST_SWEEPS):
        change = 0.0
        for node in range(ORDER):
            for q in range(quantities):
                i = node * quantities + q
                w[motion + q] = w[free + i] + dot(tab, shifts + i * bodies * ORDER, w, changes, bodies * ORDER)
            apply_laws(d, n, s, mode, s[at.TIME] + NODES[node] * length, w, motion, new)
            for body in range(bodies):
                value = w[new + body] - w[forces + body]
                change = max(change, abs(value - w[values + body * ORDER + node]))
                w[values + body * ORDER + node] = value
        for body in range(bodies):
            for order in range(ORDER):
                total = 0.0
                for node in range(ORDER):
                    total += COEFFICIENTS[order, node] * w[values + body * ORDER + node]
                w[changes + body * ORDER + order] = total
        if change * min(change / before, 1.0) <= SWEEP_TOLERANCE * scale:
            quartic = 0.0
            for body in range(bodies):
                quartic = max(quartic, abs(w[changes + body * ORDER + ORDER - 1]))
            return quartic <= QUARTIC_TOLERANCE * scale
        if sweep > 0 and change > SLOW * before and not last:
            return False
        before = change
    return False


@njit
def variation(w: Numbers, changes: int) -> float:
    """Bound of how much a force varies over the step."""
    total = 0.0
    for order in range(ORDER):
        total += (order + 1) * abs(w[changes + order])
    return total
