"""One control step of many arms that differ in their numbers only."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places
from flexarm_env.plant.control_step import control_step, drive_output
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.modes import is_stuck, record
from flexarm_env.plant.readings import measure
from flexarm_env.plant.replay import is_lost
from flexarm_env.plant.truth import TRUTH_ANGLE, TRUTH_DEFLECTION, TRUTH_LOST, TRUTH_SIZE, TRUTH_SPEED, TRUTH_STUCK

# --- offsets of a batch's quantities in its array, and distances from one arm's to the next
(
    AT_CONSTANTS, CONSTANTS_EACH, AT_STATES, STATE_EACH, AT_COMMANDS, AT_TAP_COMMANDS, AT_NOISELESS, AT_SCRATCH, SCRATCH_EACH,
) = range(9)  # fmt: skip


@njit(forceinline=True)
def write_truth(d: Numbers, n: Places, s: Numbers, out: Numbers, first: int) -> None:
    """Write the truth (TRUTH_SIZE,), see truth, to out from `first` on."""
    mode = int(s[at.MODE])
    size, count = 2 * n[at.BLOCKS], n[at.COORDINATES]
    rows = record(n, mode) + n[at.PHYSICAL]
    stuck = is_stuck(mode, 0)
    out[first + TRUTH_ANGLE] = s[at.HELD_HUB] if stuck else inner_product(d, rows, s, at.Z_START, size)
    out[first + TRUTH_SPEED] = 0.0 if stuck else inner_product(d, rows + count * size, s, at.Z_START, size)
    deflection = inner_product(d, rows + n[at.TIP] * size, s, at.Z_START, size) if n[at.TIP] >= 0 else 0.0
    out[first + TRUTH_DEFLECTION] = deflection
    out[first + TRUTH_STUCK] = 1.0 if stuck else 0.0
    out[first + TRUTH_LOST] = 1.0 if is_lost(n, s) else 0.0


@njit
def write_noiseless(arena: Numbers, n: Places, offsets: Places, first: int, last: int) -> None:
    """Write noiseless readings, then the truth, of arms first to last - 1 (see step_batch)."""
    for arm in range(first, last):
        constants = arena[offsets[AT_CONSTANTS] + arm * offsets[CONSTANTS_EACH] :]
        state = arena[offsets[AT_STATES] + arm * offsets[STATE_EACH] :]
        measure(constants, n, state, arena, offsets[AT_NOISELESS] + arm * (n[at.SIGNALS] + TRUTH_SIZE))
        write_truth(constants, n, state, arena, offsets[AT_NOISELESS] + arm * (n[at.SIGNALS] + TRUTH_SIZE) + n[at.SIGNALS])


@njit
def step_batch(arena: Numbers, n: Places, offsets: Places, first: int, last: int, part: int) -> None:
    """Advance arms first to last - 1 by one sample and write their readings and truth.

    All numbers lie in one array, at `offsets`, since numba pays for each array at each call. Every arm has the layout n, and
    its own constants unless CONSTANTS_EACH is 0. The command of a tap on its hub is added to the drive's output. `part` is the
    number of a thread, which has a scratch of its own.
    """
    scratch = arena[offsets[AT_SCRATCH] + part * offsets[SCRATCH_EACH] :]
    for arm in range(first, last):
        constants = arena[offsets[AT_CONSTANTS] + arm * offsets[CONSTANTS_EACH] :]
        state = arena[offsets[AT_STATES] + arm * offsets[STATE_EACH] :]
        tap_command = arena[offsets[AT_TAP_COMMANDS] + arm]
        before = state[at.COMMAND]
        command = drive_output(constants, n, state, arena[offsets[AT_COMMANDS] + arm])
        control_step(constants, n, state, before + tap_command, command + tap_command, scratch)
    write_noiseless(arena, n, offsets, first, last)
