"""Derivatives of the blocks' motion under a force that is a polynomial in time."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Samples
from flexarm_env.plant.modes import record
from flexarm_env.plant.tangents.bundles import PER_RESPONSE, PER_TABLE, Tangent, TangentPlaces


@njit
def write_force(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, command: float, order: int) -> None:
    """Write the force on the blocks and its derivatives, from the laws' forces and theirs; the state is that at `start` in v."""
    d, n, v, w, gd, gs = a.d, a.n, g.v, g.w, g.d, g.s
    here, size, count, lanes = record(n, mode), 2 * n[at.BLOCKS], n[at.BODIES] + n[at.POINTS], gd.shape[1]
    coupled = n[at.COUPLED] > 0
    side, hub, motor = v[p.start + at.GEAR_SIDE], v[p.start + at.HELD_HUB], v[p.start + at.HELD_MOTOR]
    for i in range(size):
        by, out = here + n[at.FORCING] + i, p.lanes_force + i
        at_command, at_one, at_side = by + at.W_COMMAND * size, by + at.W_ONE * size, by + at.W_SIDE * size
        at_hub, at_motor = by + at.W_HELD_HUB * size, by + at.W_HELD_MOTOR * size
        total, by_command = d[at_command] * command + d[at_one], d[at_command]
        for x in range(lanes):
            w[out, x] = gd[at_command, x] * command + gd[at_one, x] + by_command * w[p.lanes_command, x]
        if coupled:
            by_hub, by_motor = d[at_hub], d[at_motor]
            total += d[at_side] * side + by_hub * hub + by_motor * motor
            for x in range(lanes):
                w[out, x] += gd[at_side, x] * side + gd[at_hub, x] * hub + gd[at_motor, x] * motor
                w[out, x] += by_hub * gs[at.HELD_HUB, x] + by_motor * gs[at.HELD_MOTOR, x]
        v[p.phi + i] = total
    for i in range(size, (order + 1) * size):
        v[p.phi + i] = 0.0
        for x in range(lanes):
            w[p.lanes_force + i, x] = 0.0
    for power in range(order + 1):
        for j in range(count):
            column, own = here + n[at.FORCE_COLUMNS] + j * size, v[p.coefficients + power * count + j]
            change = p.lanes_coefficients + power * count + j
            for i in range(size):
                by, out = d[column + i], p.lanes_force + power * size + i
                v[p.phi + power * size + i] += by * own
                for x in range(lanes):
                    w[out, x] += gd[column + i, x] * own + by * w[change, x]


@njit
def move_lanes(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, order: int, table: int) -> None:
    """Write the blocks' state at the time of a table to v, and its derivatives at that time to w, from those at the start."""
    d, n, v, w, gd, gs = a.d, a.n, g.v, g.w, g.d, g.s
    here, size, lanes = record(n, mode), 2 * n[at.BLOCKS], gd.shape[1]
    for k in range(n[at.BLOCKS]):
        at0, at1 = here + n[at.C0] + k, here + n[at.C1] + k
        c0, c1, i = d[at0], d[at1], table + PER_TABLE * k
        c, s, first, second = v[i], v[i + 1], p.lanes_z + 2 * k, p.lanes_z + 2 * k + 1
        z = p.start + at.Z_START + 2 * k
        y, q = v[z], v[z + 1]
        pp, qp, qq = c, -c0 * s, c - c1 * s
        new_y, new_q = pp * y + s * q, qp * y + qq * q
        c_0, s_0, c_1, s_1 = v[i + PER_RESPONSE], v[i + PER_RESPONSE + 1], v[i + 2 * PER_RESPONSE], v[i + 2 * PER_RESPONSE + 1]
        y_0, q_0 = c_0 * y + s_0 * q, -(s + c0 * s_0) * y + (c_0 - c1 * s_0) * q
        y_1, q_1 = c_1 * y + s_1 * q, -c0 * s_1 * y + (c_1 - s - c1 * s_1) * q
        for power in range(order + 1):
            one, two = v[p.phi + power * size + 2 * k], v[p.phi + power * size + 2 * k + 1]
            j = i + 1 + power
            fast, slow = v[j], v[j + 1]
            new_y += one * (fast + c1 * slow) + two * slow
            new_q += two * fast - c0 * slow * one
            fast_0, slow_0, fast_1, slow_1 = (
                v[j + PER_RESPONSE],
                v[j + PER_RESPONSE + 1],
                v[j + 2 * PER_RESPONSE],
                v[j + 2 * PER_RESPONSE + 1],
            )
            y_0 += one * (fast_0 + c1 * slow_0) + two * slow_0
            q_0 += two * fast_0 - (slow + c0 * slow_0) * one
            y_1 += one * (fast_1 + slow + c1 * slow_1) + two * slow_1
            q_1 += two * fast_1 - c0 * slow_1 * one
        v[p.z + 2 * k], v[p.z + 2 * k + 1] = new_y, new_q
        zp, f1 = at.Z_START + 2 * k, p.lanes_force + 2 * k
        a1, a2 = s + c1 * v[i + 2], v[i + 2]
        b1 = -c0 * v[i + 2]
        for x in range(lanes):
            moved = pp * gs[zp, x] + s * gs[zp + 1, x] + y_0 * gd[at0, x] + y_1 * gd[at1, x]
            w[first, x] = moved + a1 * w[f1, x] + a2 * w[f1 + 1, x]
        for x in range(lanes):
            moved = qp * gs[zp, x] + qq * gs[zp + 1, x] + q_0 * gd[at0, x] + q_1 * gd[at1, x]
            w[second, x] = moved + b1 * w[f1, x] + s * w[f1 + 1, x]
        for power in range(1, order + 1):
            fast, slow = v[i + 1 + power], v[i + 2 + power]
            f1 += size
            a1, b1 = fast + c1 * slow, -c0 * slow
            for x in range(lanes):
                w[first, x] += a1 * w[f1, x] + slow * w[f1 + 1, x]
            for x in range(lanes):
                w[second, x] += b1 * w[f1, x] + fast * w[f1 + 1, x]


@njit
def block_rates(a: Arrays, g: Tangent, p: TangentPlaces, mode: int, order: int, t: float, out: int) -> None:
    """Write ż of the state at z in v, t [s] after the start, to v at `out`, which may be z."""
    d, n, v = a.d, a.n, g.v
    here, size = record(n, mode), 2 * n[at.BLOCKS]
    for k in range(n[at.BLOCKS]):
        one, two, power = 0.0, 0.0, 1.0
        for j in range(order + 1):
            one += v[p.phi + j * size + 2 * k] * power
            two += v[p.phi + j * size + 2 * k + 1] * power
            power *= t / (j + 1)
        y, q = v[p.z + 2 * k], v[p.z + 2 * k + 1]
        v[out + 2 * k] = q + one
        v[out + 2 * k + 1] = two - d[here + n[at.C0] + k] * y - d[here + n[at.C1] + k] * q


@njit
def add_row(a: Arrays, g: Tangent, row: int, z: int, lanes_z: int, out: int) -> float:
    """Add the derivatives of a row of d times the state at z in v, whose own are in w, to w at `out`; return the product."""
    d, v, w, gd, size = a.d, g.v, g.w, g.d, 2 * a.n[at.BLOCKS]
    total = 0.0
    for i in range(size):
        by, own = d[row + i], v[z + i]
        total += by * own
        for x in range(gd.shape[1]):
            w[out, x] += by * w[lanes_z + i, x] + gd[row + i, x] * own
    return total


@njit
def clear(w: Samples, first: int, count: int) -> None:
    """Set rows to zero."""
    for i in range(first, first + count):
        for x in range(w.shape[1]):
            w[i, x] = 0.0


@njit(forceinline=True)
def keep_state(a: Arrays, g: Tangent, p: TangentPlaces) -> None:
    """Copy the state to v, where a step starts."""
    for i in range(at.Z_START + 2 * a.n[at.BLOCKS]):
        g.v[p.start + i] = a.s[i]


@njit
def start_lanes(a: Arrays, g: Tangent, p: TangentPlaces) -> None:
    """Copy the blocks' state at the start, and its derivatives, to z."""
    for i in range(2 * a.n[at.BLOCKS]):
        g.v[p.z + i] = g.v[p.start + at.Z_START + i]
        for x in range(g.d.shape[1]):
            g.w[p.lanes_z + i, x] = g.s[at.Z_START + i, x]
