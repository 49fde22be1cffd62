"""One sample of a replay with derivatives, as control_step: the command before the delay's end, then the new one."""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Arrays
from flexarm_env.plant.control_step import mean_during_ramp
from flexarm_env.plant.forces import evaluate_forces
from flexarm_env.plant.substep import UNTABULATED
from flexarm_env.plant.tangents.bundles import KEY_DELAY, Tangent, TangentPlaces
from flexarm_env.plant.tangents.laws import NUDGE, shift_laws
from flexarm_env.plant.tangents.motion import keep_state
from flexarm_env.plant.tangents.steps import begin_step, move_with_lanes, step_lanes, whole_lanes


@njit(forceinline=True)
def use_command(g: Tangent, p: TangentPlaces, row: int) -> None:
    """Copy the derivatives of a command to those of the one in effect."""
    for x in range(g.w.shape[1]):
        g.w[p.lanes_command, x] = g.w[row, x]


@njit(forceinline=True)
def apply_command(a: Arrays, g: Tangent, p: TangentPlaces, command: float) -> None:
    """Store the command in effect and its derivatives, on which the load of the gears depends."""
    a.s[at.COMMAND] = command
    for x in range(g.w.shape[1]):
        g.s[at.COMMAND, x] = g.w[p.lanes_command, x]


@njit
def shift_start(a: Arrays, g: Tangent, p: TangentPlaces, before: float) -> None:
    """Carry the derivatives over the time before the delay's end, which is of no length but may change."""
    n = a.n
    begin_step(g, p, 0)
    keep_state(a, g, p)
    mode = int(a.s[at.MODE])
    evaluate_forces(a, mode, mode, 0)
    for j in range(n[at.BODIES] + n[at.POINTS]):
        g.v[p.coefficients + j] = a.w[j]
    whole_lanes(a, g, p, mode, before, 0, 0.0, UNTABULATED)


class Ramp(NamedTuple):
    """The drive's way from one output to the next.

    Attributes:
        before: output [A or V] before the command.
        command: output [A or V] at the ramp's end.
        lanes_before: row of w with the derivatives of the first.
        lanes_command: row of w with those of the second.
        since: time [s] at which parts are counted from 0, since the ramp began.
    """

    before: float
    command: float
    lanes_before: int
    lanes_command: int
    since: float


@njit(forceinline=True)
def ramp_lanes(a: Arrays, g: Tangent, p: TangentPlaces, ramp: Ramp, part: int, length: float) -> float:
    """Compute the drive's mean output as mean_during_ramp does, and its derivatives as those of the command in effect.

    Args:
        a: arrays of the plant.
        g: their derivatives; row lanes_length of w has those of the length.
        p: places of both.
        ramp: on which the drive is.
        part: number of the part of the time, from `since` on; below 0 before it.
        length: of each part [s].
    """
    d, n, w, before, command, since = a.d, a.n, g.w, ramp.before, ramp.command, ramp.since
    start, end, nudge = since + part * length, since + (part + 1) * length, NUDGE * length
    if n[n[at.DRIVE_LAWS]] == 0 and n[n[at.RAMP_LAWS]] == 0:
        return command
    use_command(g, p, ramp.lanes_command)
    if n[n[at.RAMP_LAWS]] == 0:
        return command
    found = mean_during_ramp(d, n, before, command, start, end)
    by_before = mean_during_ramp(d, n, before + NUDGE, command, start, end)
    by_before = (by_before - mean_during_ramp(d, n, before - NUDGE, command, start, end)) / (2.0 * NUDGE)
    by_command = mean_during_ramp(d, n, before, command + NUDGE, start, end)
    by_command = (by_command - mean_during_ramp(d, n, before, command - NUDGE, start, end)) / (2.0 * NUDGE)
    later, late = part * nudge, (part + 1) * nudge
    by_length = mean_during_ramp(d, n, before, command, start + later, end + late)
    by_length = (by_length - mean_during_ramp(d, n, before, command, start - later, end - late)) / (2.0 * nudge)
    for x in range(w.shape[1]):
        w[p.lanes_command, x] = by_before * w[ramp.lanes_before, x] + by_command * w[ramp.lanes_command, x]
        w[p.lanes_command, x] += by_length * w[p.lanes_length, x]
        step = w[p.lanes_step, x]
        if step != 0.0:
            shift_laws(a, g, p, x, step)
            above = mean_during_ramp(d, n, before, command, start, end)
            shift_laws(a, g, p, x, -step)
            below = mean_during_ramp(d, n, before, command, start, end)
            shift_laws(a, g, p, x, 0.0)
            w[p.lanes_command, x] += (above - below) / (2.0 * step)
    return found


@njit(forceinline=True)
def ramps(a: Arrays, g: Tangent, p: TangentPlaces, before: float, command: float) -> tuple[Ramp, Ramp]:
    """Describe the ramp of the sample before, which goes on until the delay is over, and that to the new command."""
    for x in range(g.w.shape[1]):
        g.w[p.lanes_earlier, x] = g.s[at.EARLIER, x]
    last = Ramp(a.s[at.EARLIER], before, p.lanes_earlier, p.lanes_before, a.d[at.INTERVAL])
    return last, Ramp(before, command, p.lanes_before, p.lanes_now, 0.0)


@njit(forceinline=True)
def end_sample(a: Arrays, g: Tangent, p: TangentPlaces, before: float, own: float) -> None:
    """Store the drive's output of this sample and of the one before, with their derivatives."""
    use_command(g, p, p.lanes_now)
    apply_command(a, g, p, own)
    a.s[at.EARLIER] = before
    for x in range(g.w.shape[1]):
        g.s[at.EARLIER, x] = g.w[p.lanes_before, x]


@njit(forceinline=True)
def control_lanes(a: Arrays, g: Tangent, p: TangentPlaces, before: float, command: float) -> None:
    """Advance by one sample as control_step does, with derivatives: rows lanes_before and lanes_now of w have the commands'."""
    d, n, w, own = a.d, a.n, g.w, a.s[at.COMMAND]
    early = n[at.EARLY_SUBSTEPS]
    last, new = ramps(a, g, p, before, command)
    if n[n[at.DRIVE_LAWS]] > 0:
        use_command(g, p, p.lanes_before)
    if early == 0 and g.v[p.keys + KEY_DELAY] > 0.0:
        shift_start(a, g, p, before)
    for j in range(early + n[at.LATE_SUBSTEPS]):
        slot, ramp = int(j >= early), new if j >= early else last
        for x in range(w.shape[1]):
            w[p.lanes_length, x] = g.d[at.EARLY_LENGTH + slot, x]
        now = ramp_lanes(a, g, p, ramp, j - early, d[at.EARLY_LENGTH + slot])
        apply_command(a, g, p, now)
        step_lanes(a, g, p, now, d[at.EARLY_LENGTH + slot], slot)
    end_sample(a, g, p, before, own)


@njit
def uneven_lanes(a: Arrays, g: Tangent, p: TangentPlaces, before: float, command: float, interval: float) -> None:
    """Advance by a sample as uneven_step does, with derivatives."""
    d, n, w, gd, own = a.d, a.n, g.w, g.d, a.s[at.COMMAND]
    whole = d[at.EARLY_LENGTH] * n[at.EARLY_SUBSTEPS]
    early = min(whole, interval)
    late, cut = interval - early, early < whole
    last, new = ramps(a, g, p, before, command)
    use_command(g, p, p.lanes_before)
    for x in range(w.shape[1]):
        w[p.lanes_length, x] = gd[at.EARLY_LENGTH, x] * n[at.EARLY_SUBSTEPS]
    now = ramp_lanes(a, g, p, last, -1, whole)
    apply_command(a, g, p, now)
    for x in range(w.shape[1]):
        w[p.lanes_length, x] = 0.0 if cut else w[p.lanes_length, x]
    if early > 0.0:
        move_with_lanes(a, g, p, now, early, UNTABULATED)
    elif g.v[p.keys + KEY_DELAY] > 0.0:
        shift_start(a, g, p, before)
    longest = max(d[at.EARLY_LENGTH], d[at.LATE_LENGTH])  # one of them is next to nothing where the delay ends at a sample
    count = max(math.ceil(late / longest - 1e-9), 1) if late > 0.0 else 0
    for j in range(count):
        for x in range(w.shape[1]):
            w[p.lanes_length, x] = 0.0 if cut else gd[at.LATE_LENGTH, x] * n[at.LATE_SUBSTEPS] / count
        now = ramp_lanes(a, g, p, new, j, late / count)
        apply_command(a, g, p, now)
        move_with_lanes(a, g, p, now, late / count, UNTABULATED)
    end_sample(a, g, p, before, own)
