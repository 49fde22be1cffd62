"""A whole run: initial state, commands, readings, and their feedback to the state."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Gains, Numbers, Places, Samples, Segment
from flexarm_env.plant.control_step import control_step, drive_output, uneven_step
from flexarm_env.plant.forces import angle_of
from flexarm_env.plant.friction import preslides
from flexarm_env.plant.modes import GEAR_OPEN, is_stuck
from flexarm_env.plant.readings import measure
from flexarm_env.plant.stick_slip import decide_stick_or_slip, enter_mode

#: Sum of block coordinates beyond which a replay ends in NaN.
RUN_AWAY = 1e9


@njit
def place_at(d: Numbers, n: Places, s: Numbers, physical: Numbers, command: float, w: Numbers) -> None:
    """Set a physical state (states,); a body at rest sticks if friction holds it."""
    mode = 0
    if d[at.GAP] > 0.0:
        windup = physical[1] - physical[0]
        s[at.GEAR_SIDE] = 0.0
        if windup >= 0.5 * d[at.GAP]:
            s[at.GEAR_SIDE] = 1.0
        elif windup <= -0.5 * d[at.GAP]:
            s[at.GEAR_SIDE] = -1.0
        else:
            mode = GEAR_OPEN
    for i in range(n[at.STATES]):
        w[i] = physical[i]
    for body in range(n[at.BODIES]):
        speed = physical[n[at.COORDINATES] + body]
        s[at.HUB_DIRECTION + body] = 1.0 if speed >= 0.0 else -1.0
        if speed == 0.0 and not preslides(n, body):
            mode |= 1 << body
    s[at.KNOWN_ANGLE], s[at.KNOWN_FRICTION] = physical[0], 0.0
    enter_mode(d, n, s, mode, w, 0)
    for body in range(n[at.BODIES]):
        if is_stuck(int(s[at.MODE]), body):
            decide_stick_or_slip(Arrays(d, n, s, w), body, command, 0, n[at.STATES])


@njit
def feed_back(
    d: Numbers, n: Places, s: Numbers, gains: Gains, measured: Samples, readings: Numbers, k: int,
) -> None:  # fmt: skip
    """Correct the state by gains (modes, signals, 2 blocks + bodies) times the error of each reading that was measured."""
    mode = int(s[at.MODE])
    size = 2 * n[at.BLOCKS]
    for j in range(n[at.SIGNALS]):
        if math.isnan(measured[k, j]):
            continue
        error = measured[k, j] - readings[k * n[at.SIGNALS] + j]
        for i in range(size):
            s[at.Z_START + i] += gains[mode, j, i] * error
        for body in range(n[at.BODIES]):
            if is_stuck(mode, body):
                s[at.HELD_HUB + body] += gains[mode, j, size + body] * error
    if preslides(n, 0):  # friction does not build up against a correction
        s[at.KNOWN_ANGLE] = angle_of(d, n, s, mode, 0, Segment(s, at.Z_START))


@njit(forceinline=True)
def is_lost(n: Places, s: Numbers) -> bool:
    """Whether the state has diverged: by feedback gains that do not suit the arm, or by unreasonable values."""
    total = 0.0
    for i in range(2 * n[at.BLOCKS]):
        total += abs(s[at.Z_START + i])
    return not total < RUN_AWAY


@njit
def replay(
    d: Numbers, n: Places, s: Numbers, commands: Numbers, intervals: Numbers, readings: Numbers,
    gains: Gains, measured: Samples, w: Numbers,
) -> None:  # fmt: skip
    """Apply commands (samples,) and write readings (samples · signals,), each taken before its command acts.

    `intervals` (samples,) holds the sampling times [s] where they are uneven, else nothing. With gains, each reading's
    error against `measured` (samples, signals) is fed back (innovations form), unless that is NaN; without, both are empty.
    """
    count = commands.shape[0]
    for k in range(count):
        measure(d, n, s, readings, k * n[at.SIGNALS])
        if is_lost(n, s):
            for i in range(k * n[at.SIGNALS], count * n[at.SIGNALS]):
                readings[i] = math.nan
            return
        if gains.shape[0]:
            feed_back(d, n, s, gains, measured, readings, k)
        if k + 1 == count:
            return
        before = s[at.COMMAND]
        command = drive_output(d, n, s, commands[k])
        if intervals.shape[0]:
            uneven_step(Arrays(d, n, s, w), before, command, intervals[k])
        else:
            control_step(d, n, s, before, command, w)
