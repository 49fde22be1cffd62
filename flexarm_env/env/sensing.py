"""From an arm's noiseless readings to its observation: delay, noise, steps, range, drop-outs; and taps on its hub."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from flexarm_env.env.draws import GOLDEN, mixed, normal, uniform
from flexarm_env.env.layout import (
    AT_SENSORS,
    AT_SETTINGS,
    COMMAND_PER_TORQUE,
    DEPTH,
    DROP_CHANCE,
    DROP_LEFT,
    DROP_SAMPLES,
    DROPPED,
    INVERSE_SCALE,
    INVERSE_STEP,
    LARGEST,
    LARGEST_TAP_TORQUE,
    NOISE,
    SAMPLE_COUNT,
    SENSOR,
    SHARE_OF_DELAY,
    SIGNALS,
    STEP,
    TAP_CHANCE,
    TAP_LEFT,
    TAP_SAMPLES,
    TAP_TORQUE,
    TARGET,
    TARGET_SCALE,
    WHOLE_DELAY,
    history_of,
    noiseless_of,
    output_of,
    own_of,
    row_of,
)

#: Streams of draws of one episode.
SENSORS_STREAM, TAPS_STREAM, DROPS_STREAM = 1, 2, 3


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def draw_tap_command(a, offsets, key, arm):
    """Draw a tap on the hub in the next sample; return it as an addition to the command [A or V]."""
    settings, own = offsets[AT_SETTINGS], own_of(offsets, arm)
    if a[own + TAP_LEFT] <= 0.0 and a[settings + TAP_CHANCE] > 0.0:
        counter = 2 * int(a[row_of(offsets, SAMPLE_COUNT, arm)])
        if uniform(key, TAPS_STREAM, counter) < a[settings + TAP_CHANCE]:
            a[own + TAP_LEFT] = a[settings + TAP_SAMPLES]
            a[own + TAP_TORQUE] = a[settings + LARGEST_TAP_TORQUE] * (2.0 * uniform(key, TAPS_STREAM, counter + 1) - 1.0)
    if a[own + TAP_LEFT] <= 0.0:
        return 0.0
    a[own + TAP_LEFT] -= 1.0
    return a[own + TAP_TORQUE] * a[own + COMMAND_PER_TORQUE]


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def write_observation(a, offsets, key, observations, arm):
    """Write an arm's sensor outputs over their scales, then the target, to observations (arms, signals + 1).

    A sensor is late by its delay, noisy, goes in steps and ends at its largest reading; one that has dropped out repeats
    its last output.
    """
    settings, signals = offsets[AT_SETTINGS], offsets[SIGNALS]
    sample_count = int(a[row_of(offsets, SAMPLE_COUNT, arm)])
    noiseless, output = noiseless_of(offsets, arm), output_of(offsets, arm)
    dropped = _dropped_sensor(a, offsets, key, sample_count, arm) if a[settings + DROP_CHANCE] > 0.0 else -1
    late = offsets[DEPTH] > 0
    stream = mixed(key + np.uint64(SENSORS_STREAM) * GOLDEN)
    for j in range(signals):
        sensor = offsets[AT_SENSORS] + j * SENSOR
        quantity = _delayed(a, offsets, sensor, sample_count, arm, j) if late else a[noiseless + j]
        reading = quantity + a[sensor + NOISE] * normal(stream, sample_count * signals + j)
        if a[sensor + STEP] > 0.0:
            reading = np.rint(reading * a[sensor + INVERSE_STEP]) * a[sensor + STEP] + 0.0
        if not math.isfinite(reading) or j == dropped:
            reading = a[output + j]
        reading = min(max(reading, -a[sensor + LARGEST]), a[sensor + LARGEST])
        a[output + j] = reading
        observations[arm, j] = reading * a[sensor + INVERSE_SCALE]
    observations[arm, signals] = a[row_of(offsets, TARGET, arm)] / a[settings + TARGET_SCALE]


@njit(cache=True, error_model="numpy", _nrt=False)
def _delayed(a, offsets, sensor, sample_count, arm, j):
    """Store the noiseless reading of an arm's sensor j, and return the one that its delay lets out now."""
    signals, depth = offsets[SIGNALS], offsets[DEPTH]
    history = history_of(offsets, arm) + j
    a[history + (sample_count % depth) * signals] = a[noiseless_of(offsets, arm) + j]
    late = sample_count - int(a[sensor + WHOLE_DELAY])
    quantity, before = a[history + (max(late, 0) % depth) * signals], a[history + (max(late - 1, 0) % depth) * signals]
    return quantity + a[sensor + SHARE_OF_DELAY] * (before - quantity)


@njit(cache=True, error_model="numpy", _nrt=False)
def _dropped_sensor(a, offsets, key, sample_count, arm):
    """Draw drop-outs; return the number of the arm's sensor that has dropped out, or -1."""
    settings, own = offsets[AT_SETTINGS], own_of(offsets, arm)
    may = a[own + DROP_LEFT] <= 0.0 and sample_count > 0
    if may and uniform(key, DROPS_STREAM, 2 * sample_count) < a[settings + DROP_CHANCE]:
        a[own + DROP_LEFT] = a[settings + DROP_SAMPLES]
        a[own + DROPPED] = math.floor(offsets[SIGNALS] * uniform(key, DROPS_STREAM, 2 * sample_count + 1))
    if a[own + DROP_LEFT] <= 0.0:
        return -1
    a[own + DROP_LEFT] -= 1.0
    return int(a[own + DROPPED])
