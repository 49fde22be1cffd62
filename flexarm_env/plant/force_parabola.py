"""Forces that vary with the motion over a substep: parabolas in time (exponential collocation of order four)."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Blocks, Numbers, Places, Segment, SubstepScratch
from flexarm_env.plant.forces import apply_laws, evaluate_forces, read_motion
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.modes import record
from flexarm_env.plant.propagate import RESPONSE, advance

SWEEPS = 15


@njit(forceinline=True)
def constant_forcing(a: Arrays, command: float, mode: int, force: int) -> None:
    """Write the constant part of the force on the blocks: command, constant torque, gears' side, held angles."""
    d, n, s, w = a.d, a.n, a.s, a.w
    size = 2 * n[at.BLOCKS]
    by = record(n, mode) + n[at.FORCING]
    for i in range(size):
        w[force + i] = d[by + at.W_COMMAND * size + i] * command + d[by + at.W_ONE * size + i]
        w[force + i + size] = w[force + i + 2 * size] = 0.0
    if n[at.COUPLED]:
        side, hub, motor = s[at.GEAR_SIDE], s[at.HELD_HUB], s[at.HELD_MOTOR]
        for i in range(size):
            held = d[by + at.W_HELD_HUB * size + i] * hub + d[by + at.W_HELD_MOTOR * size + i] * motor
            w[force + i] += d[by + at.W_SIDE * size + i] * side + held


@njit(forceinline=True)
def add_forces(d: Numbers, n: Places, mode: int, w: Numbers, coefficients: int, force: int) -> None:
    """Add torques and drag, given by their coefficients of 1, t, t²/2, to the force on the blocks."""
    count, size = n[at.BODIES] + n[at.POINTS], 2 * n[at.BLOCKS]
    for order in range(3 if n[at.VARYING] else 1):
        column = record(n, mode) + n[at.FORCE_COLUMNS]
        for j in range(count):
            c = w[coefficients + order * count + j]
            for i in range(size):
                w[force + order * size + i] += d[column + i] * c
            column += size


@njit
def influence_size(n: Places) -> int:
    """Count the numbers of a table of the forces' influence, with room for one row (see force_influence)."""
    count = n[at.BODIES] + n[at.POINTS]
    return (n[at.BODIES] + count) * 3 * count + 2 * n[at.BLOCKS]


@njit
def force_influence(d: Numbers, n: Places, mode: int, table: Segment, to: Segment) -> None:
    """Write the change of each quantity of read_motion by each force, order by order, at the time of the table.

    A quantity u p + v P of each block answers to a force 1, t, t²/2 on the block by a row, which is the same for all forces.
    """
    here, size, blocks = record(n, mode), 2 * n[at.BLOCKS], n[at.BLOCKS]
    bodies, count = n[at.BODIES], n[at.BODIES] + n[at.POINTS]
    out, answer = to.first, to.first + (bodies + count) * 3 * count
    for i in range(bodies + count):
        row = here + n[at.DRAG_VELOCITY] + (i - 2 * bodies) * size
        if i < bodies:
            row = here + n[at.ANGLE] + i * size
        elif i < 2 * bodies:
            row = here + n[at.SPEED] + (i - bodies) * size
        for order in range(3):
            first = table.first + (order + 1) * blocks  # S and R₀, R₀ and R₁, or R₁ and R₂
            for k in range(blocks):
                faster, slower = table.data[first + k], table.data[first + blocks + k]
                u, v, c0, c1 = d[row + 2 * k], d[row + 2 * k + 1], d[here + n[at.C0] + k], d[here + n[at.C1] + k]
                to.data[answer + 2 * k] = u * (faster + c1 * slower) - v * c0 * slower
                to.data[answer + 2 * k + 1] = u * slower + v * faster
            for j in range(count):
                to.data[out + j] = inner_product(to.data, answer, d, here + n[at.FORCE_COLUMNS] + j * size, size)
            out += count


@njit
def fit_parabola(w: Numbers, start: int, middle: int, end: int, count: int, t: float, out: int) -> None:
    """Write coefficients of 1, t, t²/2 of the parabolas through values at the start, middle and end of t."""
    for j in range(count):
        a, b, c = w[start + j], w[middle + j], w[end + j]
        w[out + j] = a
        w[out + count + j] = (4.0 * b - 3.0 * a - c) / t
        w[out + 2 * count + j] = 4.0 * (a - 2.0 * b + c) / (t * t)


@njit
def fit_forces(a: Arrays, command: float, t: float, table: Segment, shifts: Segment, places: SubstepScratch) -> None:
    """Fit the forces over t [s] by parabolas through their values at start, middle and end of the motion that they cause.

    Exponential collocation on Lobatto points, of order four (Hochbruck and Ostermann, Exponential integrators, Acta Numerica
    2010, section 2.2), solved by sweeps over the few quantities that enter the laws. `table` has the blocks' responses, `shifts`
    the forces' influence on these quantities, both at the middle, then at the end.
    """
    d, n, s, w = a.d, a.n, a.s, a.w
    mode = int(s[at.MODE])
    here = record(n, mode)
    blocks, count, quantities = n[at.BLOCKS], n[at.BODIES] + n[at.POINTS], 2 * n[at.BODIES] + n[at.POINTS]
    nodes, motion, coefficients = places.nodes, places.motion, places.coefficients
    new, free = nodes + 3 * count, motion + quantities
    evaluate_forces(a, mode, mode, nodes)
    constant_forcing(a, command, mode, places.force)
    steady, state = Blocks(here + n[at.C0], here + n[at.C1], blocks, 0), Segment(s, at.Z_START)
    for half in range(2):
        advance(d, steady, Segment(table.data, table.first + half * RESPONSE * blocks), state, w, places.force, places.trial)
        read_motion(a, mode, Segment(w, places.trial), free + half * quantities)
    for j in range(count):
        w[nodes + count + j] = w[nodes + 2 * count + j] = w[nodes + j]
    before = 1.0
    for _ in range(SWEEPS):
        fit_parabola(w, nodes, nodes + count, nodes + 2 * count, count, t, coefficients)
        change = 0.0
        for half in range(2):
            for i in range(quantities):
                row = shifts.first + half * influence_size(n) + 3 * count * i
                moved = inner_product(shifts.data, row, w, coefficients, 3 * count)
                w[motion + i] = w[free + half * quantities + i] + moved
            apply_laws(a, mode, s[at.TIME] + 0.5 * (half + 1) * t, motion, new + half * count)
        for j in range(2 * count):
            change = max(change, abs(w[new + j] - w[nodes + count + j]))
            w[nodes + count + j] = w[new + j]
        if change * min(change / before, 1.0) < d[at.TOLERANCE]:  # estimate of the change by all further sweeps
            break
        before = change
    fit_parabola(w, nodes, nodes + count, nodes + 2 * count, count, t, coefficients)
    add_forces(d, n, mode, w, coefficients, places.force)
