"""Offsets of all numbers of a batch of arms, which lie in one array: the kernels pay for each array that they are given."""

from __future__ import annotations

from numba import njit

#: An action is clipped to ±1. Beyond this one it comes from a fault of its sender, as infinity does, and is refused.
LARGEST_ACTION = 1e6

# --- settings: one number each, for all arms; the weights of the reward's terms come last
(
    INTERVAL, HALF_PERIOD, RANGE, LIMIT, TAP_CHANCE, LARGEST_TAP_TORQUE, TAP_SAMPLES, DROP_CHANCE, DROP_SAMPLES,
    TARGET_SCALE, WEIGHTS,
) = range(11)  # fmt: skip

# --- columns of each arm's own numbers
FIRST_TARGET, FIRST_ANGLE, TAP_LEFT, TAP_TORQUE, DROP_LEFT, DROPPED, LENGTH, COMMAND_PER_TORQUE = range(8)
COLUMNS = 8

# --- rows of the outcome of a step, one number for each arm; HUB_ANGLE to STUCK are the truth up to TRUTH_LOST (plant.truth), in
# its order; the reward's terms come last
REWARD, TERMINATED, SAMPLE_COUNT, HUB_ANGLE, HUB_SPEED, TIP_DEFLECTION, STUCK, TARGET, COMMAND, TERMS = range(10)

# --- columns of each sensor's numbers
NOISE, STEP, INVERSE_STEP, LARGEST, INVERSE_SCALE, WHOLE_DELAY, SHARE_OF_DELAY = range(7)
SENSOR = 7

# --- offsets: where each quantity begins in the common array, and how far one arm's or row's numbers are from the next
(
    AT_SETTINGS, AT_SENSORS, AT_OWN, AT_NOISELESS, NOISELESS_EACH, AT_REQUESTED, AT_TAP_COMMANDS, AT_HISTORY, AT_SENSOR_OUTPUT,
    AT_OUTCOME, ROW_EACH, SIGNALS, DEPTH,
) = range(13)  # fmt: skip
OFFSETS = 13


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def row_of(offsets, row, arm):
    """Locate an arm's number in a row of the outcome."""
    return offsets[AT_OUTCOME] + row * offsets[ROW_EACH] + arm


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def own_of(offsets, arm):
    """Locate an arm's own numbers."""
    return offsets[AT_OWN] + arm * COLUMNS


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def noiseless_of(offsets, arm):
    """Locate an arm's readings without noise, delay and steps."""
    return offsets[AT_NOISELESS] + arm * offsets[NOISELESS_EACH]


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def truth_of(offsets, arm):
    """Locate an arm's truth, behind its readings without noise."""
    return noiseless_of(offsets, arm) + offsets[SIGNALS]


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def output_of(offsets, arm):
    """Locate an arm's last sensor output."""
    return offsets[AT_SENSOR_OUTPUT] + arm * offsets[SIGNALS]


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def history_of(offsets, arm):
    """Locate an arm's past readings (depth, signals)."""
    return offsets[AT_HISTORY] + arm * offsets[DEPTH] * offsets[SIGNALS]
