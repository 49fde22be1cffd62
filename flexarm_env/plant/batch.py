"""One control step of many arms that differ in their numbers only."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.control_step import control_step, drive_output
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.propagate import inlined_dot
from flexarm_env.plant.readings import measure
from flexarm_env.plant.replay import is_lost

#: Columns of the truth after the readings: hub angle and speed, tip deflection, whether the hub sticks, whether it diverged.
TRUTH = 5

# --- places of a batch's quantities in its array, and distances from one arm's to the next
AT_CONSTANTS, CONSTANTS_EACH, AT_STATES, STATE_EACH, AT_COMMANDS, AT_PUSHES, AT_LOOKS, AT_SCRATCH, SCRATCH_EACH = range(9)


@njit(forceinline=True)
def write_truth(d: Numbers, n: Places, s: Numbers, out: Numbers, first: int) -> None:
    """Write hub angle [rad], hub speed [rad/s], tip deflection [m] and whether the hub sticks, to out from `first` on."""
    mode = int(s[at.MODE])
    size, count = 2 * n[at.BLOCKS], n[at.COORDINATES]
    rows = record(n, mode) + n[at.PHYSICAL]
    stuck = is_stuck(mode, 0)
    out[first] = s[at.HELD_HUB] if stuck else inlined_dot(d, rows, s, at.Z_START, size)
    out[first + 1] = 0.0 if stuck else inlined_dot(d, rows + count * size, s, at.Z_START, size)
    out[first + 2] = inlined_dot(d, rows + (count - 2) * size, s, at.Z_START, size) if count > n[at.BODIES] else 0.0
    out[first + 3] = 1.0 if stuck else 0.0
    out[first + 4] = 1.0 if is_lost(n, s) else 0.0


@njit
def look_batch(arena: Numbers, n: Places, places: Places, first: int, last: int) -> None:
    """Write readings without noise, then the truth, of arms first to last - 1 (see step_batch)."""
    for arm in range(first, last):
        constants = arena[places[AT_CONSTANTS] + arm * places[CONSTANTS_EACH] :]
        state = arena[places[AT_STATES] + arm * places[STATE_EACH] :]
        measure(constants, n, state, arena, places[AT_LOOKS] + arm * (n[at.SIGNALS] + TRUTH))
        write_truth(constants, n, state, arena, places[AT_LOOKS] + arm * (n[at.SIGNALS] + TRUTH) + n[at.SIGNALS])


@njit
def step_batch(arena: Numbers, n: Places, places: Places, first: int, last: int, part: int) -> None:
    """Advance arms first to last - 1 by one sample and write their readings and truth.

    All numbers lie in one array, at `places`, since numba pays for each array at each call. Every arm has the layout n, and
    its own constants unless CONSTANTS_EACH is 0. Its push is added to the drive's output for its command. `part` is the
    number of a thread, which has a scratch of its own.
    """
    scratch = arena[places[AT_SCRATCH] + part * places[SCRATCH_EACH] :]
    for arm in range(first, last):
        constants = arena[places[AT_CONSTANTS] + arm * places[CONSTANTS_EACH] :]
        state = arena[places[AT_STATES] + arm * places[STATE_EACH] :]
        push = arena[places[AT_PUSHES] + arm]
        before = state[at.COMMAND]
        command = drive_output(constants, n, state, arena[places[AT_COMMANDS] + arm])
        control_step(constants, n, state, before + push, command + push, scratch)
    look_batch(arena, n, places, first, last)
