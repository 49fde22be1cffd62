"""Means over cells and the agreement of two signals, by signals of known factor, lag and gaps."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env.identify.inspect.agreement import agreement, agreement_late
from flexarm_env.identify.inspect.free_run import cell_means
from flexarm_env.identify.settings import SETTINGS

NUMBERS = SETTINGS.motion
CELL = 0.01
TIME = np.arange(0.0, 10.0, CELL)


def waves(time: np.ndarray) -> np.ndarray:
    """Two tones without a common period, after a start at 1 s."""
    gone = np.maximum(time - 1.0, 0.0)
    return np.sin(2 * np.pi * 0.7 * gone) + 0.3 * np.sin(2 * np.pi * 2.3 * gone)


@pytest.mark.parametrize("gain", [0.159, 2.0, -3.0])
def test_gain_and_share_despite_offset_and_drift(gain):
    found = agreement(gain * waves(TIME) + 0.4 + 0.1 * TIME, waves(TIME), CELL, NUMBERS)
    assert found.gain == pytest.approx(gain)
    assert found.share == pytest.approx(1.0)


@pytest.mark.parametrize("lag", [0.5, 0.234, -0.12])
def test_lag_is_found_between_cells(lag):
    found = agreement_late(2.0 * waves(TIME - lag), waves(TIME), CELL, NUMBERS)
    assert found.lag == pytest.approx(lag, abs=2 * NUMBERS.lag_resolution)
    assert found.gain == pytest.approx(2.0, rel=0.01)


def test_a_signal_that_never_moves_has_nothing_in_common():
    found = agreement(np.full(len(TIME), 3.0), waves(TIME), CELL, NUMBERS)
    assert (found.gain, found.share) == (0.0, 0.0)


def test_cell_means_leave_out_readings_that_are_missing():
    time = np.arange(8) * 0.005
    means = cell_means(time, np.array([[1.0, 3.0, np.nan, 5.0, 6.0, 8.0, 1.0, 1.0]]).T, 0.01, 3)
    assert means[:, 0].tolist() == [2.0, 5.0, 7.0, 1.0]


def test_cell_means_bridge_short_gaps_alone():
    time, values = np.arange(12) * 0.01, np.arange(12.0)
    values[[2, 3]] = values[[5, 6, 7, 8]] = np.nan
    means = cell_means(time, values[:, None], 0.01, 3)[:, 0]
    assert means[[2, 3]].tolist() == [2.0, 3.0]
    assert np.isnan(means[5:9]).all()
    assert means[9:].tolist() == [9.0, 10.0, 11.0]
