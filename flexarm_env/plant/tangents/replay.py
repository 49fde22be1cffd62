"""A whole run with the derivatives of its readings."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Numbers, Samples, Segment
from flexarm_env.plant.control_step import drive_output
from flexarm_env.plant.forces import angle_of
from flexarm_env.plant.friction import preslides
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.laws import drive_law, sensor_law
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.readings import measure
from flexarm_env.plant.replay import feed_back, is_lost
from flexarm_env.plant.tangents.bundles import Run, Tangent, TangentPlaces, tangent_places
from flexarm_env.plant.tangents.control_step import control_lanes, uneven_lanes
from flexarm_env.plant.tangents.laws import NUDGE, keep_laws, shift_laws
from flexarm_env.plant.tangents.motion import clear
from flexarm_env.plant.tangents.steady import forget_ones, prepare_steady


@njit
def linear_readings(a: Arrays, g: Tangent, p: TangentPlaces) -> None:
    """Write the readings without the sensors' laws to v."""
    d, n, s, size = a.d, a.n, a.s, 2 * a.n[at.BLOCKS]
    here = record(n, int(s[at.MODE]))
    for i in range(n[at.SIGNALS]):
        row = here + n[at.OUTPUT_DRIVERS] + i * n[at.DRIVERS]
        total = inner_product(d, here + n[at.OUTPUT] + i * size, s, at.Z_START, size) + d[row + at.W_ONE]
        total += d[row + at.W_HELD_HUB] * s[at.HELD_HUB] + d[row + at.W_HELD_MOTOR] * s[at.HELD_MOTOR]
        g.v[p.readings + i] = total


@njit
def angle_lanes(a: Arrays, g: Tangent, body: int, out: int) -> float:
    """Write the derivatives of a body's angle on the arm's side to w at `out`; return the angle."""
    d, n, s, w, gs, size = a.d, a.n, a.s, g.w, g.s, 2 * a.n[at.BLOCKS]
    mode = int(s[at.MODE])
    holds, row = d[record(n, mode) + n[at.HOLDS_ANGLE] + body], record(n, mode) + n[at.ANGLE] + body * size
    for x in range(w.shape[1]):
        w[out, x] = holds * gs[at.HELD_HUB + body, x]
    for j in range(size):
        for x in range(w.shape[1]):
            w[out, x] += d[row + j] * gs[at.Z_START + j, x] + g.d[row + j, x] * s[at.Z_START + j]
    return angle_of(d, n, s, mode, body, Segment(s, at.Z_START))


@njit
def sensor_lanes(a: Arrays, g: Tangent, p: TangentPlaces, to: Samples, first: int) -> None:
    """Change the derivatives of the readings by the sensors' laws."""
    d, n, v, w = a.d, a.n, g.v, g.w
    place, out, ratio, time = n[at.SENSOR_LAWS], p.lanes_motion, d[at.GEAR_RATIO], a.s[at.TIME]
    angle = angle_lanes(a, g, 0, out)
    turned = angle_lanes(a, g, n[at.BODIES] - 1, out + 1)
    motor = ratio * turned
    linear_readings(a, g, p)
    for j in range(n[place]):
        entry = place + 1 + 3 * j
        kind, law, i = n[entry], n[entry + 1], n[entry + 2]
        y = v[p.readings + i]
        by_y = sensor_law(kind, y + NUDGE, angle, motor, time, d, law) - sensor_law(kind, y - NUDGE, angle, motor, time, d, law)
        by_hub = sensor_law(kind, y, angle + NUDGE, motor, time, d, law) - sensor_law(kind, y, angle - NUDGE, motor, time, d, law)
        by_motor = sensor_law(kind, y, angle, motor + NUDGE, time, d, law)
        by_motor -= sensor_law(kind, y, angle, motor - NUDGE, time, d, law)
        for x in range(w.shape[1]):
            turns = ratio * w[out + 1, x] + g.d[at.GEAR_RATIO, x] * turned
            to[first + i, x] = (by_y * to[first + i, x] + by_hub * w[out, x] + by_motor * turns) / (2.0 * NUDGE)
            step = w[p.lanes_step, x]
            if step != 0.0:
                shift_laws(a, g, p, x, step)
                above = sensor_law(kind, y, angle, motor, time, d, law)
                shift_laws(a, g, p, x, -step)
                below = sensor_law(kind, y, angle, motor, time, d, law)
                shift_laws(a, g, p, x, 0.0)
                to[first + i, x] += (above - below) / (2.0 * step)
        v[p.readings + i] = sensor_law(kind, y, angle, motor, time, d, law)


@njit(forceinline=True)
def measure_lanes(a: Arrays, g: Tangent, p: TangentPlaces, to: Samples, first: int) -> None:
    """Write the derivatives of the readings to rows from `first` on."""
    d, n, s, gs, gd = a.d, a.n, a.s, g.s, g.d
    mode, size, lanes = int(s[at.MODE]), 2 * n[at.BLOCKS], gs.shape[1]
    here = record(n, mode)
    for i in range(n[at.SIGNALS]):
        row, rows, out = here + n[at.OUTPUT_DRIVERS] + i * n[at.DRIVERS], here + n[at.OUTPUT] + i * size, first + i
        for x in range(lanes):
            to[out, x] = gd[row + at.W_ONE, x]
        if mode & 3:
            hub, motor, by_hub, by_motor = s[at.HELD_HUB], s[at.HELD_MOTOR], d[row + at.W_HELD_HUB], d[row + at.W_HELD_MOTOR]
            for x in range(lanes):
                to[out, x] += gd[row + at.W_HELD_HUB, x] * hub + gd[row + at.W_HELD_MOTOR, x] * motor
            for x in range(lanes):
                to[out, x] += by_hub * gs[at.HELD_HUB, x] + by_motor * gs[at.HELD_MOTOR, x]
        z, four = at.Z_START, size - size % 4
        for j in range(0, four, 4):
            o, k = rows + j, z + j
            y0, y1, y2, y3, b0, b1, b2, b3 = s[k], s[k + 1], s[k + 2], s[k + 3], d[o], d[o + 1], d[o + 2], d[o + 3]
            for x in range(lanes):
                moved = b0 * gs[k, x] + b1 * gs[k + 1, x] + b2 * gs[k + 2, x] + b3 * gs[k + 3, x]
                to[out, x] += moved + gd[o, x] * y0 + gd[o + 1, x] * y1 + gd[o + 2, x] * y2 + gd[o + 3, x] * y3
        for j in range(four, size, 2):
            o, k = rows + j, z + j
            y0, y1, b0, b1 = s[k], s[k + 1], d[o], d[o + 1]
            for x in range(lanes):
                to[out, x] += b0 * gs[k, x] + b1 * gs[k + 1, x] + gd[o, x] * y0 + gd[o + 1, x] * y1
    if n[n[at.SENSOR_LAWS]] > 0:
        sensor_lanes(a, g, p, to, first)


@njit
def feed_back_lanes(a: Arrays, g: Tangent, run: Run, innovations: Numbers, k: int) -> None:
    """Correct the derivatives of the state as feed_back corrects the state.

    The physical gains are constant; those of the blocks change with the blocks.
    """
    n, s, gs, to, by = a.n, a.s, g.s, run.derivatives, run.gain_lanes
    mode, size, lanes, signals = int(s[at.MODE]), 2 * n[at.BLOCKS], gs.shape[1], n[at.SIGNALS]
    for j in range(0, signals, 2):  # two at a time
        other = min(j + 1, signals - 1)
        error, second = innovations[j], innovations[other]
        there, more = 0.0 if math.isnan(error) else 1.0, 0.0 if other == j or math.isnan(second) else 1.0
        error, second = error if there > 0.0 else 0.0, second if more > 0.0 else 0.0
        out, also = k * signals + j, k * signals + other
        for i in range(size):
            gain, further, row = there * run.gains[mode, j, i], more * run.gains[mode, other, i], (mode * size + i) * signals
            first, last = row + j, row + other
            for x in range(lanes):
                moved = by[first, x] * error + by[last, x] * second
                gs[at.Z_START + i, x] += moved - gain * to[out, x] - further * to[also, x]
        for body in range(n[at.BODIES]):
            if is_stuck(mode, body):
                gain, further = there * run.gains[mode, j, size + body], more * run.gains[mode, other, size + body]
                for x in range(lanes):
                    gs[at.HELD_HUB + body, x] -= gain * to[out, x] + further * to[also, x]


@njit
def know_angle(a: Arrays, g: Tangent) -> None:
    """Write the derivatives of the angle that a hub that preslides remembers, at the corrected state."""
    n, s = a.n, a.s
    row = record(n, int(s[at.MODE])) + n[at.ANGLE]
    clear(g.s, at.KNOWN_ANGLE, 1)
    for i in range(2 * n[at.BLOCKS]):
        for x in range(g.s.shape[1]):
            g.s[at.KNOWN_ANGLE, x] += a.d[row + i] * g.s[at.Z_START + i, x] + g.d[row + i, x] * s[at.Z_START + i]


@njit
def correct(a: Arrays, g: Tangent, p: TangentPlaces, run: Run, k: int) -> None:
    """Feed the errors of a sample's readings back to the state, and to its derivatives."""
    n, signals = a.n, a.n[at.SIGNALS]
    for j in range(signals):
        g.v[p.readings + j] = run.measured[k, j] - run.readings[k * signals + j]
    feed_back_lanes(a, g, run, g.v[p.readings :], k)
    feed_back(a.d, n, a.s, run.gains, run.measured, run.readings, k)
    if n[at.COUPLED]:
        forget_ones(g, p)
    if preslides(n, 0):
        know_angle(a, g)


@njit(forceinline=True)
def drive_lanes(a: Arrays, g: Tangent, p: TangentPlaces, command: float) -> None:
    """Write the derivatives of the drive's output for a command, and of the one before, to w; the state has the one before."""
    d, n, s, w, gs = a.d, a.n, a.s, g.w, g.s
    place, before, lanes = n[at.DRIVE_LAWS], s[at.COMMAND], w.shape[1]
    if n[place] == 0:
        return
    for x in range(lanes):
        w[p.lanes_before, x], w[p.lanes_now, x] = gs[at.COMMAND, x], 0.0
    for j in range(n[place]):
        kind, law = n[place + 1 + 2 * j], n[place + 2 + 2 * j]
        by_command = drive_law(kind, command + NUDGE, before, d[at.INTERVAL], d, law)
        by_command = (by_command - drive_law(kind, command - NUDGE, before, d[at.INTERVAL], d, law)) / (2.0 * NUDGE)
        by_before = drive_law(kind, command, before + NUDGE, d[at.INTERVAL], d, law)
        by_before = (by_before - drive_law(kind, command, before - NUDGE, d[at.INTERVAL], d, law)) / (2.0 * NUDGE)
        for x in range(lanes):
            w[p.lanes_now, x] = by_command * w[p.lanes_now, x] + by_before * w[p.lanes_before, x]
            step = w[p.lanes_step, x]
            if step != 0.0:
                shift_laws(a, g, p, x, step)
                above = drive_law(kind, command, before, d[at.INTERVAL], d, law)
                shift_laws(a, g, p, x, -step)
                below = drive_law(kind, command, before, d[at.INTERVAL], d, law)
                shift_laws(a, g, p, x, 0.0)
                w[p.lanes_now, x] += (above - below) / (2.0 * step)
        command = drive_law(kind, command, before, d[at.INTERVAL], d, law)
    for x in range(lanes):
        gs[at.COMMAND, x] = w[p.lanes_now, x]


@njit
def replay_with_lanes(a: Arrays, g: Tangent, run: Run) -> None:
    """Write readings as replay does, and their derivatives; `d` of the arrays is changed and restored."""
    d, n, s, readings, tangents = a.d, a.n, a.s, run.readings, run.derivatives
    count, signals, p = run.commands.shape[0], n[at.SIGNALS], tangent_places(d, n)
    keep_laws(a, g, p)
    for x in range(g.w.shape[1]):
        g.w[p.lanes_step, x] = run.steps[x]
    prepare_steady(a, g, p)
    for k in range(count):
        measure(d, n, s, readings, k * signals)
        measure_lanes(a, g, p, tangents, k * signals)
        if is_lost(n, s):
            for i in range(k * signals, count * signals):
                readings[i] = math.nan
                for x in range(tangents.shape[1]):
                    tangents[i, x] = math.nan
            return
        if run.gains.shape[0]:
            correct(a, g, p, run, k)
        if k + 1 == count:
            return
        before = s[at.COMMAND]
        drive_lanes(a, g, p, run.commands[k])
        command = drive_output(d, n, s, run.commands[k])
        if run.intervals.shape[0]:
            uneven_lanes(a, g, p, before, command, run.intervals[k])
        else:
            control_lanes(a, g, p, before, command)
