"""One control step of the arm: exact motion between events, the events, and the forces that vary with the motion."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant.ahead import copy_size
from flexarm_env.plant.events import AGAIN, GEARS, NOTHING, found_at, next_event
from flexarm_env.plant.glide import glide
from flexarm_env.plant.laws import drive_law, sensor_law
from flexarm_env.plant.layout import (
    BLOCKS,
    BODIES,
    C0,
    C1,
    COMMAND,
    COORDINATES,
    DRIVE_LAWS,
    DRIVERS,
    EARLY_LENGTH,
    EARLY_SUBSTEPS,
    GAP,
    GEAR_RATIO,
    GEAR_SIDE,
    GLIDES,
    HEADER,
    HELD_HUB,
    HELD_MOTOR,
    HUB_DIRECTION,
    INTERVAL,
    KNOWN_ANGLE,
    KNOWN_FRICTION,
    LATE_LENGTH,
    LATE_SUBSTEPS,
    MODE,
    OUTPUT,
    OUTPUT_DRIVERS,
    POINTS,
    REACH,
    RESPONSES,
    SENSOR_LAWS,
    SIGNALS,
    SPEED,
    STATES,
    TIME,
    TORQUE_LAWS,
    VARYING,
    W_HELD_HUB,
    W_HELD_MOTOR,
    W_ONE,
    Gains,
    Numbers,
    Places,
    Samples,
)
from flexarm_env.plant.propagate import (
    RESPONSE,
    advance,
    dot,
    inlined_dot,
    respond,
)
from flexarm_env.plant.slide import DEPTH, prepare_slide, slide, slide_table, table_size
from flexarm_env.plant.stick_slip import (
    GEAR_OPEN,
    angle_of,
    enter,
    evaluate_forces,
    is_stuck,
    preslides,
    record,
    remember,
    settle,
    to_physical,
)
from flexarm_env.plant.varying import add_forces, collocate, constant_forcing, reach

#: After an event the next is looked for this much later [s], twice as much after each further one in the same substep,
#: so that events that crowd (white noise at zero speed) cannot hold time still.
FIRST_BLIND_TIME = 1e-11
UNTABULATED = -1
#: Sum of block coordinates beyond which a replay gives up and reports NaN.
RUN_AWAY = 1e9


@njit
def substep_scratch(n: Places) -> int:
    """How many numbers of scratch a substep needs."""
    count = n[BODIES] + n[POINTS]
    return 26 * n[BLOCKS] + copy_size(n[BLOCKS]) + n[STATES] + (14 + 12 * count) * count + 64


@njit
def scratch_size(n: Places) -> int:
    """How many numbers of scratch the kernel needs."""
    return substep_scratch(n) + (table_size(n) if n[VARYING] else 0)


@njit(forceinline=True)
def happen(
    d: Numbers, n: Places, s: Numbers, kind: int, which: float, command: float, w: Numbers,
    physical: int, coefficients: int,
) -> None:  # fmt: skip
    """Let an event take place."""
    mode = int(s[MODE])
    if kind == AGAIN:
        return
    if kind != GEARS:
        settle(d, n, s, int(which), command, w, physical, coefficients)
        return
    to_physical(d, n, s, mode, w, physical)
    if mode & GEAR_OPEN:
        s[GEAR_SIDE] = which
        enter(d, n, s, mode & ~GEAR_OPEN, w, physical)
    else:
        s[GEAR_SIDE] = 0.0
        enter(d, n, s, mode | GEAR_OPEN, w, physical)


@njit(forceinline=True)
def face_motion(d: Numbers, n: Places, s: Numbers, mode: int) -> None:
    """Let friction oppose the motion of a state that was set or corrected from outside."""
    size = 2 * n[BLOCKS]
    for body in range(n[BODIES]):
        if not is_stuck(mode, body):
            speed = dot(d, record(n, mode) + n[SPEED] + body * size, s, HEADER, size)
            if speed * s[HUB_DIRECTION + body] < 0.0:
                s[HUB_DIRECTION + body] *= -1.0


@njit
def substep(d: Numbers, n: Places, s: Numbers, command: float, t: float, slot: int, w: Numbers) -> None:
    """Move the arm on by t [s] under a held command; `slot` names the tabulated responses for exactly t."""
    blocks = n[BLOCKS]
    size, count = 2 * n[BLOCKS], n[BODIES] + n[POINTS]
    trial, force = 0, size
    coefficients = force + 3 * size
    nodes = coefficients + 3 * count
    motion = nodes + 5 * count
    sizes = motion + 6 * count
    found = found_at(sizes, blocks)
    own = found + size
    own_reach = own + 2 * RESPONSE * blocks
    physical = own_reach + (12 * count * count if n[VARYING] else 0)
    shift = (2 * n[BODIES] + n[POINTS]) * 3 * count
    left, blind = t, 0.0
    face_motion(d, n, s, int(s[MODE]))
    while left > 0.0:
        mode = int(s[MODE])
        here = record(n, mode)
        c0, c1 = here + n[C0], here + n[C1]
        known = slot >= 0 and blind == 0.0
        table = d if known else w
        middle = here + n[RESPONSES] + slot * 2 * RESPONSE * blocks if known else own
        end = middle + RESPONSE * blocks
        if not known:
            respond(d, c0, c1, blocks, left, w, end)
        if n[VARYING]:
            shifts = here + n[REACH] + slot * 2 * shift if known else own_reach
            if not known:
                respond(d, c0, c1, blocks, 0.5 * left, w, middle)
                reach(d, n, mode, w, middle, w, own_reach)
                reach(d, n, mode, w, end, w, own_reach + shift)
            collocate(d, n, s, mode, command, left, table, middle, table, shifts, w, trial, nodes, motion, force, coefficients)
        else:
            constant_forcing(d, n, s, command, mode, w, force)
            evaluate_forces(d, n, s, mode, mode, w, coefficients)
            add_forces(d, n, mode, w, coefficients, force)
        advance(d, c0, c1, blocks, table, end, s, HEADER, w, force, n[VARYING], trial)
        when, kind, which = next_event(d, n, s, mode, command, w, trial, force, coefficients, sizes, min(blind, left), left)
        when = left if kind == NOTHING else when
        if when > 0.0:
            for i in range(size):
                s[HEADER + i] = w[(trial if kind == NOTHING else found) + i]
            s[TIME] += when
        remember(d, n, s)
        if kind == NOTHING:
            return
        happen(d, n, s, kind, which, command, w, physical, coefficients)
        left -= when
        blind = max(2.0 * blind, FIRST_BLIND_TIME)


@njit(forceinline=True)
def let_through(d: Numbers, n: Places, s: Numbers, command: float) -> float:
    """Return what the drive makes of a command, and remember it."""
    place = n[DRIVE_LAWS]
    for j in range(n[place]):
        command = drive_law(n[place + 1 + 2 * j], command, s[COMMAND], d[INTERVAL], d, n[place + 2 + 2 * j])
    s[COMMAND] = command
    return command


@njit
def rests(n: Places, mode: int) -> bool:
    """Whether the hub of an arm of one body is held and no force varies for that."""
    return n[BODIES] == 1 and mode == 1 and n[n[TORQUE_LAWS]] == 0


@njit
def walk(d: Numbers, n: Places, s: Numbers, command: float, t: float, slot: int, w: Numbers) -> None:
    """Move the arm on by t [s] in slides, halved where the force varies fast or an event may fall in, else substeps."""
    whole, done, level = 1 << DEPTH, 0, 0
    own, own_mode, own_level = substep_scratch(n), UNTABULATED, 0
    while done < whole:
        mode, part = int(s[MODE]), whole >> level
        length = t * 0.5**level
        if slot >= 0 and level == 0 and rests(n, mode):
            moved = glide(d, n, s, command, length, slot, w)
        elif slot >= 0:
            moved = slide(d, n, s, command, length, level == DEPTH, d, slide_table(n, mode, slot, level), w)
        else:
            if own_mode != mode or own_level != level:
                prepare_slide(d, n, mode, length, w, own)
                own_mode, own_level = mode, level
            moved = slide(d, n, s, command, length, level == DEPTH, w, own, w)
        if not moved and level < DEPTH:
            level += 1
            continue
        if not moved:
            substep(d, n, s, command, length, UNTABULATED, w)
        done += part
        if level > 0 and done % (2 * part) == 0:
            level -= 1


@njit(forceinline=True)
def move(d: Numbers, n: Places, s: Numbers, command: float, t: float, slot: int, w: Numbers) -> None:
    """Move the arm on by t [s] under a held command; `slot` names the tables for exactly t."""
    if n[VARYING] and not n[POINTS]:
        walk(d, n, s, command, t, slot, w)
        return
    if n[GLIDES] == 2 and slot >= 0 and slide(d, n, s, command, t, True, d, slide_table(n, int(s[MODE]), slot, 0), w):
        return
    substep(d, n, s, command, t, slot, w)


@njit
def control_step(d: Numbers, n: Places, s: Numbers, before: float, command: float, w: Numbers) -> None:
    """Move the arm on by one sample: the last command acts until the delay is over, then the new one."""
    for _ in range(n[EARLY_SUBSTEPS]):
        if n[GLIDES] != 1 or not glide(d, n, s, before, d[EARLY_LENGTH], 0, w):
            move(d, n, s, before, d[EARLY_LENGTH], 0, w)
    for _ in range(n[LATE_SUBSTEPS]):
        if n[GLIDES] != 1 or not glide(d, n, s, command, d[LATE_LENGTH], 1, w):
            move(d, n, s, command, d[LATE_LENGTH], 1, w)


@njit(inline="always")
def uneven_step(
    d: Numbers, n: Places, s: Numbers, before: float, command: float, interval: float, w: Numbers,
) -> None:  # fmt: skip
    """Like control_step, over an interval that is not the tabulated one."""
    early = min(d[EARLY_LENGTH] * n[EARLY_SUBSTEPS], interval)
    late = interval - early
    if early > 0.0:
        move(d, n, s, before, early, UNTABULATED, w)
    count = max(math.ceil(late / d[LATE_LENGTH] - 1e-9), 1) if late > 0.0 else 0
    for _ in range(count):
        move(d, n, s, command, late / count, UNTABULATED, w)


@njit
def show(d: Numbers, n: Places, s: Numbers, out: Numbers, at: int) -> None:
    """Turn readings into what the sensors' laws make of them."""
    mode, place = int(s[MODE]), n[SENSOR_LAWS]
    angle = angle_of(d, n, s, mode, 0, s, HEADER)
    motor_angle = d[GEAR_RATIO] * angle_of(d, n, s, mode, n[BODIES] - 1, s, HEADER)
    for j in range(n[place]):
        law = place + 1 + 3 * j
        i = at + n[law + 2]
        out[i] = sensor_law(n[law], out[i], angle, motor_angle, s[TIME], d, n[law + 1])


@njit(forceinline=True)
def measure(d: Numbers, n: Places, s: Numbers, out: Numbers, at: int) -> None:
    """Write the readings, without noise, to out from `at` on."""
    here = record(n, int(s[MODE]))
    size = 2 * n[BLOCKS]
    for i in range(n[SIGNALS]):
        row = here + n[OUTPUT_DRIVERS] + i * n[DRIVERS]
        total = inlined_dot(d, here + n[OUTPUT] + i * size, s, HEADER, size) + d[row + W_ONE]
        out[at + i] = total + d[row + W_HELD_HUB] * s[HELD_HUB] + d[row + W_HELD_MOTOR] * s[HELD_MOTOR]
    if n[n[SENSOR_LAWS]] > 0:
        show(d, n, s, out, at)


@njit
def place_at(d: Numbers, n: Places, s: Numbers, physical: Numbers, command: float, w: Numbers) -> None:
    """Put the arm into a physical state (states,): a body at rest sticks if friction holds it."""
    mode = 0
    if d[GAP] > 0.0:
        windup = physical[1] - physical[0]
        s[GEAR_SIDE] = 0.0
        if windup >= 0.5 * d[GAP]:
            s[GEAR_SIDE] = 1.0
        elif windup <= -0.5 * d[GAP]:
            s[GEAR_SIDE] = -1.0
        else:
            mode = GEAR_OPEN
    for i in range(n[STATES]):
        w[i] = physical[i]
    for body in range(n[BODIES]):
        speed = physical[n[COORDINATES] + body]
        s[HUB_DIRECTION + body] = 1.0 if speed >= 0.0 else -1.0
        if speed == 0.0 and not preslides(n, body):
            mode |= 1 << body
    s[KNOWN_ANGLE], s[KNOWN_FRICTION] = physical[0], 0.0
    enter(d, n, s, mode, w, 0)
    for body in range(n[BODIES]):
        if is_stuck(int(s[MODE]), body):
            settle(d, n, s, body, command, w, 0, n[STATES])


@njit
def feed_back(
    d: Numbers, n: Places, s: Numbers, gains: Gains, measured: Samples, readings: Numbers, k: int,
) -> None:  # fmt: skip
    """Correct the state by gains (modes, 2 blocks + bodies, signals) times the error of each reading."""
    mode = int(s[MODE])
    size = 2 * n[BLOCKS]
    for j in range(n[SIGNALS]):
        error = measured[k, j] - readings[k * n[SIGNALS] + j]
        for i in range(size):
            s[HEADER + i] += gains[mode, i, j] * error
        for body in range(n[BODIES]):
            if is_stuck(mode, body):
                s[HELD_HUB + body] += gains[mode, size + body, j] * error
    if preslides(n, 0):  # a correction is no motion, against which friction would build up
        s[KNOWN_ANGLE] = angle_of(d, n, s, mode, 0, s, HEADER)


@njit(forceinline=True)
def is_lost(n: Places, s: Numbers) -> bool:
    """Whether the state has run away: a feedback that does not suit the arm, or values beyond reason."""
    total = 0.0
    for i in range(2 * n[BLOCKS]):
        total += abs(s[HEADER + i])
    return not total < RUN_AWAY


@njit
def replay(
    d: Numbers, n: Places, s: Numbers, commands: Numbers, intervals: Numbers, readings: Numbers,
    gains: Gains, measured: Samples, w: Numbers,
) -> None:  # fmt: skip
    """Play commands (samples,) and fill readings (samples · signals,), each taken before its command acts.

    `intervals` (samples,) holds the sampling times [s] where they are uneven, else nothing. With gains, each reading's
    error against `measured` (samples, signals) is fed back (innovations form); without, both are empty.
    """
    count = commands.shape[0]
    for k in range(count):
        measure(d, n, s, readings, k * n[SIGNALS])
        if is_lost(n, s):
            for i in range(k * n[SIGNALS], count * n[SIGNALS]):
                readings[i] = math.nan
            return
        if gains.shape[0]:
            feed_back(d, n, s, gains, measured, readings, k)
        if k + 1 == count:
            return
        before = s[COMMAND]
        command = let_through(d, n, s, commands[k])
        if intervals.shape[0]:
            uneven_step(d, n, s, before, command, intervals[k], w)
        else:
            control_step(d, n, s, before, command, w)
