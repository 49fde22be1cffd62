"""One control step of the arm: the command before the delay's end, then the new one, in the longest steps that hold no event."""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays, Numbers, Places
from flexarm_env.plant.event_free_step import event_free_step
from flexarm_env.plant.event_free_table import DEPTH, prepare_step_table, step_table, table_size, tabulated_step
from flexarm_env.plant.force_quartic import step_scratch
from flexarm_env.plant.laws import drive_law, ramp_law
from flexarm_env.plant.quiet_step import quiet_step
from flexarm_env.plant.substep import UNTABULATED, substep, substep_scratch


@njit
def table_place(n: Places) -> int:
    """Locate in w a table for a step of any length, behind the scratch of steps and substeps, which they share."""
    return max(substep_scratch(n), step_scratch(n))


@njit
def scratch_size(n: Places) -> int:
    """Count the numbers of scratch of the kernel."""
    return table_place(n) + (table_size(n) if n[at.VARYING] else 0)


@njit(forceinline=True)
def drive_output(d: Numbers, n: Places, s: Numbers, command: float) -> float:
    """Compute the drive's output [A or V] for a command, and store it."""
    place, before = n[at.DRIVE_LAWS], s[at.COMMAND]
    for j in range(n[place]):
        command = drive_law(n[place + 1 + 2 * j], command, before, d[at.INTERVAL], d, n[place + 2 + 2 * j])
    s[at.COMMAND] = command
    return command


@njit(forceinline=True)
def mean_during_ramp(d: Numbers, n: Places, before: float, command: float, start: float, end: float) -> float:
    """Compute the drive's mean output from start to end [s] after the command changed, while it ramps to the new one."""
    place = n[at.RAMP_LAWS]
    for j in range(n[place]):
        command = ramp_law(n[place + 1 + 2 * j], command, before, start, end, d, n[place + 2 + 2 * j])
    return command


@njit
def hub_rests(n: Places, mode: int) -> bool:
    """Whether the hub of an arm of one body is held, so that no force varies with its motion."""
    steady = n[n[at.TORQUE_LAWS]] == 0 and n[at.DRIVE_FEEDBACK] <= at.OPPOSED
    return n[at.BODIES] == 1 and mode == 1 and steady


@njit
def halving_steps(a: Arrays, command: float, t: float, slot: int) -> None:
    """Advance the arm by t [s] in event-free steps, halved where a force changes fast or an event may occur, then substeps."""
    d, n, s, w = a.d, a.n, a.s, a.w
    whole, done, level = 1 << DEPTH, 0, 0
    own, own_mode, own_level = step_table(n, w, table_place(n)), UNTABULATED, 0
    while done < whole:
        mode, part = int(s[at.MODE]), whole >> level
        length = t * 0.5**level
        if slot >= 0 and level == 0 and hub_rests(n, mode):
            moved = quiet_step(a, command, length, slot)
        elif slot >= 0:
            moved = event_free_step(a, command, length, level == DEPTH, tabulated_step(d, n, mode, slot, level))
        else:
            if own_mode != mode or own_level != level:
                prepare_step_table(d, n, mode, length, own)
                own_mode, own_level = mode, level
            moved = event_free_step(a, command, length, level == DEPTH, own)
        if not moved and level < DEPTH:
            level += 1
            continue
        if not moved:
            substep(a, command, length, UNTABULATED)
        done += part
        if level > 0 and done % (2 * part) == 0:
            level -= 1


@njit(forceinline=True)
def move(a: Arrays, command: float, t: float, slot: int) -> None:
    """Advance the arm by t [s] under a held command; `slot` is the number of the tables for exactly t."""
    n = a.n
    if n[at.VARYING] and not n[at.POINTS]:
        halving_steps(a, command, t, slot)
        return
    tabulated = n[at.STEADY_BODIES] == 2 and slot >= 0
    if tabulated and event_free_step(a, command, t, True, tabulated_step(a.d, n, int(a.s[at.MODE]), slot, 0)):
        return
    substep(a, command, t, slot)


@njit
def control_step(d: Numbers, n: Places, s: Numbers, before: float, command: float, w: Numbers) -> None:
    """Advance the arm by one sample: the last command acts until the delay is over, then the new one.

    The command in effect stands in s meanwhile: limits of the drive and the load of the gears depend on it. What both commands
    exceed the drive's output by is a torque beside it.
    """
    a, own, early = Arrays(d, n, s, w), s[at.COMMAND], d[at.EARLY_LENGTH]
    beside = command - own
    for j in range(n[at.EARLY_SUBSTEPS]):
        start = d[at.INTERVAL] + (j - n[at.EARLY_SUBSTEPS]) * early
        now = beside + mean_during_ramp(d, n, s[at.EARLIER], before - beside, start, start + early)
        s[at.COMMAND] = now
        if n[at.STEADY_BODIES] != 1 or not quiet_step(a, now, early, 0):
            move(a, now, early, 0)
    for j in range(n[at.LATE_SUBSTEPS]):
        now = mean_during_ramp(d, n, before, command, j * d[at.LATE_LENGTH], (j + 1) * d[at.LATE_LENGTH])
        s[at.COMMAND] = now
        if n[at.STEADY_BODIES] != 1 or not quiet_step(a, now, d[at.LATE_LENGTH], 1):
            move(a, now, d[at.LATE_LENGTH], 1)
    s[at.COMMAND], s[at.EARLIER] = own, before - beside


@njit(inline="always")
def uneven_step(a: Arrays, before: float, command: float, interval: float) -> None:
    """Advance the arm as control_step does, over an interval [s] without tables."""
    d, n, own = a.d, a.n, a.s[at.COMMAND]
    whole = d[at.EARLY_LENGTH] * n[at.EARLY_SUBSTEPS]
    early = min(whole, interval)
    late = interval - early
    if early > 0.0:
        now = mean_during_ramp(d, n, a.s[at.EARLIER], before, d[at.INTERVAL] - whole, d[at.INTERVAL])
        a.s[at.COMMAND] = now
        move(a, now, early, UNTABULATED)
    longest = max(d[at.EARLY_LENGTH], d[at.LATE_LENGTH])  # one of them is next to nothing where the delay ends at a sample
    count = max(math.ceil(late / longest - 1e-9), 1) if late > 0.0 else 0
    for j in range(count):
        now = mean_during_ramp(d, n, before, command, j * late / count, (j + 1) * late / count)
        a.s[at.COMMAND] = now
        move(a, now, late / count, UNTABULATED)
    a.s[at.COMMAND], a.s[at.EARLIER] = own, before
