"""A sample of many arms beside their physics: taps, sensors, target, reward, end.

`compose` makes one module of this file, those that it calls and the terms of a task's reward, so that its compiled
code in numba's cache is never out of date. The kernels count no references (_nrt), for the reasons given in plant/compose.py.
"""

from __future__ import annotations

import math

from numba import njit

from flexarm_env.env.layout import (
    AT_REQUESTED,
    AT_SETTINGS,
    AT_TAP_COMMANDS,
    COMMAND,
    FIRST_ANGLE,
    FIRST_TARGET,
    HALF_PERIOD,
    HUB_ANGLE,
    INTERVAL,
    LARGEST_ACTION,
    LENGTH,
    LIMIT,
    RANGE,
    REWARD,
    ROW_EACH,
    SAMPLE_COUNT,
    TARGET,
    TERMINATED,
    TERMS,
    WEIGHTS,
    own_of,
    row_of,
    truth_of,
)
from flexarm_env.env.placeholder import write_terms
from flexarm_env.env.sensing import draw_tap_command, write_observation
from flexarm_env.plant.truth import TRUTH_ANGLE, TRUTH_DEFLECTION, TRUTH_LOST, TRUTH_SPEED, TRUTH_STUCK
from flexarm_env.tasks.reward import Sample


@njit(cache=True, nogil=True, error_model="numpy", _nrt=False)
def after_step(arena, offsets, rng_keys, observations, first, last):
    """Reward and observe arms first to last - 1 after their physics, and draw the taps of their next sample.

    Args:
        arena: all numbers of the arms, one after another.
        offsets: of the quantities in the arena, see layout.
        rng_keys: (arms,) of the episodes' draws.
        observations: (arms, signals + 1), to be written.
        first: of the arms.
        last: behind the last of them.
    """
    for arm in range(first, last):
        advance_clock(arena, offsets, arm)
        move_target(arena, offsets, arm)
        command_change = write_command(arena, offsets, arm)
        failed = write_terminated(arena, offsets, arm)
        write_reward(arena, offsets, arm, command_change, failed)
        copy_truth_to_outcome(arena, offsets, arm)
        write_observation(arena, offsets, rng_keys[arm], observations, arm)
        arena[offsets[AT_TAP_COMMANDS] + arm] = draw_tap_command(arena, offsets, rng_keys[arm], arm)


@njit(cache=True, nogil=True, error_model="numpy", _nrt=False)
def after_reset(arena, offsets, rng_keys, observations, arm):
    """Observe an arm at the start of an episode, and draw the tap of its first sample."""
    copy_truth_to_outcome(arena, offsets, arm)
    write_observation(arena, offsets, rng_keys[arm], observations, arm)
    arena[offsets[AT_TAP_COMMANDS] + arm] = draw_tap_command(arena, offsets, rng_keys[arm], arm)


@njit(cache=True, nogil=True, error_model="numpy", _nrt=False)
def request(actions, arena, offsets, limit):
    """Write the commands that actions (arms,) request [A or V]; return the first arm with an impossible action, or -1."""
    requested = offsets[AT_REQUESTED]
    for arm in range(len(actions)):
        action = actions[arm]
        if not abs(action) <= LARGEST_ACTION:
            return arm
        arena[requested + arm] = min(max(action, -1.0), 1.0) * limit
    return -1


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def copy_truth_to_outcome(a, offsets, arm):
    """Copy an arm's truth, all but whether it is lost, to the rows of the outcome from HUB_ANGLE on."""
    truth, row, row_each = truth_of(offsets, arm), row_of(offsets, HUB_ANGLE, arm), offsets[ROW_EACH]
    for i in range(TRUTH_LOST):
        a[row + i * row_each] = a[truth + i]


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def advance_clock(a, offsets, arm):
    """Count an arm's sample. The sample's target, draws and time depend on this number."""
    a[row_of(offsets, SAMPLE_COUNT, arm)] += 1.0


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def move_target(a, offsets, arm):
    """Change the sign of an arm's target after each half period, where the task has one."""
    settings, own = offsets[AT_SETTINGS], own_of(offsets, arm)
    if a[settings + HALF_PERIOD] > 0.0:
        half = math.floor(a[row_of(offsets, SAMPLE_COUNT, arm)] * a[settings + INTERVAL] / a[settings + HALF_PERIOD] + 1e-9)
        a[row_of(offsets, TARGET, arm)] = a[own + FIRST_TARGET] * (1.0 if half % 2 == 0 else -1.0)


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def write_command(a, offsets, arm):
    """Write the command that an arm requested to the outcome; return its change from the sample before [A or V]."""
    command, requested = row_of(offsets, COMMAND, arm), a[offsets[AT_REQUESTED] + arm]
    change = requested - a[command]
    a[command] = requested
    return change


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def write_terminated(a, offsets, arm):
    """Write whether an arm's episode ends, and return it: the hub left its range, or the arm is lost."""
    own, truth = own_of(offsets, arm), truth_of(offsets, arm)
    turned = abs(a[truth + TRUTH_ANGLE] - a[own + FIRST_ANGLE])
    failed = a[truth + TRUTH_LOST] > 0.0 or not turned <= a[offsets[AT_SETTINGS] + RANGE]
    a[row_of(offsets, TERMINATED, arm)] = 1.0 if failed else 0.0
    return failed


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def write_reward(a, offsets, arm, command_change, failed):
    """Write an arm's reward and the reward's terms."""
    settings, own, truth = offsets[AT_SETTINGS], own_of(offsets, arm), truth_of(offsets, arm)
    angle, speed, tip = a[truth + TRUTH_ANGLE], a[truth + TRUTH_SPEED], a[truth + TRUTH_DEFLECTION]
    if a[truth + TRUTH_LOST] > 0.0:  # not finite: rewarded like a straight arm at rest at the end of its range
        angle, speed, tip = a[own + FIRST_ANGLE] + a[settings + RANGE], 0.0, 0.0
    sample = Sample(
        hub_angle=angle,
        hub_speed=speed,
        tip_deflection=tip,
        stuck=a[truth + TRUTH_STUCK] > 0.0,
        target=a[row_of(offsets, TARGET, arm)],
        command=a[row_of(offsets, COMMAND, arm)] / a[settings + LIMIT],
        command_change=command_change / a[settings + LIMIT],
        start_angle=a[own + FIRST_ANGLE],
        beam_length=a[own + LENGTH],
        time=a[row_of(offsets, SAMPLE_COUNT, arm)] * a[settings + INTERVAL],
        failed=failed,
    )
    terms = row_of(offsets, TERMS, arm)
    # write_terms of the task's own terms, which compose writes in the place of the imported one
    a[row_of(offsets, REWARD, arm)] = write_terms(a, settings + WEIGHTS, terms, offsets[ROW_EACH], sample)
