"""Derivatives of the laws' forces: by their arguments, and along each constant.

The laws are functions of an effect's own. Their slopes are local differences of these functions, not of the motion.
"""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Samples
from flexarm_env.plant.forces import apply_laws
from flexarm_env.plant.modes import record
from flexarm_env.plant.tangents.bundles import Tangent, TangentPlaces, argument_count
from flexarm_env.plant.tangents.motion import add_row, clear

#: Difference of an argument in SI units: angle, speed, time, torque, command.
NUDGE = 1e-6


@njit
def shift_laws(a: Arrays, g: Tangent, p: TangentPlaces, x: int, step: float) -> None:
    """Move the constants that laws take by a step along constant x."""
    d, n, v, gd = a.d, a.n, g.v, g.d
    for i in range(at.CONSTANTS):
        d[i] = v[p.laws + i] + step * gd[i, x]
    for i in range(d.shape[0] - n[at.PARAMETERS]):
        d[n[at.PARAMETERS] + i] = v[p.laws + at.CONSTANTS + i] + step * gd[n[at.PARAMETERS] + i, x]


@njit
def keep_laws(a: Arrays, g: Tangent, p: TangentPlaces) -> None:
    """Copy the constants that laws take to v."""
    d, n = a.d, a.n
    for i in range(at.CONSTANTS):
        g.v[p.laws + i] = d[i]
    for i in range(d.shape[0] - n[at.PARAMETERS]):
        g.v[p.laws + at.CONSTANTS + i] = d[n[at.PARAMETERS] + i]


@njit
def any_lane(w: Samples, row: int) -> bool:
    """Whether a row has a derivative other than 0."""
    total = 0.0
    for x in range(w.shape[1]):
        total += abs(w[row, x])
    return total > 0.0


@njit
def write_slopes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, time: float, node: int) -> None:
    """Write the slopes of the forces by the arguments at `motion` in v to v, for a node.

    Velocities along the beam are moved together: the drag at a point depends on that point's alone.
    """
    n, v = a.n, g.v
    bodies, points, count, arguments = n[at.BODIES], n[at.POINTS], n[at.BODIES] + n[at.POINTS], argument_count(n)
    laws, first = Arrays(a.d, n, v[p.start :], v), p.slopes + node * count * arguments
    for i in range(count * arguments):
        v[first + i] = 0.0
    motion = 2 * bodies + points
    for q in range(2 * bodies):
        own = v[p.motion + q]
        v[p.motion + q] = own + NUDGE
        apply_laws(laws, mode, time, p.motion, p.above)
        v[p.motion + q] = own - NUDGE
        apply_laws(laws, mode, time, p.motion, p.below)
        v[p.motion + q] = own
        for j in range(count):
            v[first + j * arguments + q] = (v[p.above + j] - v[p.below + j]) / (2.0 * NUDGE)
    for half in range(2 if points > 0 else 0):
        for q in range(2 * bodies, motion):
            v[p.motion + q] += NUDGE * (1.0 - 2.0 * half) * (1.0 + half)
        apply_laws(laws, mode, time, p.motion, p.below if half else p.above)
    for q in range(points):
        v[p.motion + 2 * bodies + q] += NUDGE
        j = bodies + q
        v[first + j * arguments + 2 * bodies + q] = (v[p.above + j] - v[p.below + j]) / (2.0 * NUDGE)
    for extra in range(4):
        if not any_lane(g.w, p.lanes_motion + motion + extra):
            continue
        place = p.start + (at.TIME, at.COMMAND, at.KNOWN_ANGLE, at.KNOWN_FRICTION)[extra]
        own, late = v[place], NUDGE if extra == 0 else 0.0
        v[place] = own + NUDGE
        apply_laws(laws, mode, time + late, p.motion, p.above)
        v[place] = own - NUDGE
        apply_laws(laws, mode, time - late, p.motion, p.below)
        v[place] = own
        for j in range(count):
            v[first + j * arguments + motion + extra] = (v[p.above + j] - v[p.below + j]) / (2.0 * NUDGE)


@njit
def write_arguments(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, late: int) -> None:
    """Write the arguments of the laws, from the blocks' state at z, to v, and their derivatives to w.

    Row `late` of w has the derivatives of the time since the start.
    """
    d, n, v, w, gs = a.d, a.n, g.v, g.w, g.s
    here, size, bodies, points = record(n, mode), 2 * n[at.BLOCKS], n[at.BODIES], n[at.POINTS]
    clear(w, p.lanes_motion, argument_count(n))
    for q in range(2 * bodies + points):
        row = here + n[at.DRAG_VELOCITY] + (q - 2 * bodies) * size
        if q < bodies:
            row = here + n[at.ANGLE] + q * size
        elif q < 2 * bodies:
            row = here + n[at.SPEED] + (q - bodies) * size
        v[p.motion + q] = add_row(a, g, row, p.z, p.lanes_z, p.lanes_motion + q)
    for body in range(bodies):
        holds = d[here + n[at.HOLDS_ANGLE] + body]
        v[p.motion + body] += holds * v[p.start + at.HELD_HUB + body]
        for x in range(w.shape[1]):
            w[p.lanes_motion + body, x] += holds * gs[at.HELD_HUB + body, x]
    last = p.lanes_motion + 2 * bodies + points
    for x in range(w.shape[1]):
        w[last, x] = gs[at.TIME, x] + w[late, x]
        w[last + 1, x] = gs[at.COMMAND, x]
        w[last + 2, x], w[last + 3, x] = gs[at.KNOWN_ANGLE, x], gs[at.KNOWN_FRICTION, x]


@njit
def add_law_lanes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, time: float, out: int) -> None:
    """Add the change of the forces along each constant on which the laws depend themselves to w at `out`."""
    n, v, w = a.n, g.v, g.w
    count, laws = n[at.BODIES] + n[at.POINTS], Arrays(a.d, n, v[p.start :], v)
    for x in range(w.shape[1]):
        step = w[p.lanes_step, x]
        if step == 0.0:
            continue
        shift_laws(a, g, p, x, step)
        apply_laws(laws, mode, time, p.motion, p.above)
        shift_laws(a, g, p, x, -step)
        apply_laws(laws, mode, time, p.motion, p.below)
        shift_laws(a, g, p, x, 0.0)
        for j in range(count):
            w[out + j, x] += (v[p.above + j] - v[p.below + j]) / (2.0 * step)


@njit
def add_slope_lanes(a: Arrays, g: Tangent, p: TangentPlaces, node: int, out: int) -> None:
    """Add the change of the forces with their arguments to w at `out`."""
    n, v, w = a.n, g.v, g.w
    count, arguments = n[at.BODIES] + n[at.POINTS], argument_count(n)
    for j in range(count):
        for q in range(arguments):
            slope = v[p.slopes + (node * count + j) * arguments + q]
            if slope != 0.0:
                for x in range(w.shape[1]):
                    w[out + j, x] += slope * w[p.lanes_motion + q, x]
