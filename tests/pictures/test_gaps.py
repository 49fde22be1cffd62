"""Figures of signals with absent readings."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm
from flexarm_env.identify.explain.comparison import Comparison, Replay
from flexarm_env.lab.overlay import POINTS
from flexarm_env.pictures import curves, highlight, overlays, residuals
from flexarm_env.pictures.plots import where_measured
from flexarm_env.recordings.recording import Recording

COUNT, RATE = 6000, 500.0
TIME = np.arange(COUNT) / RATE


def values(absent: np.ndarray, seed: int = 0) -> np.ndarray:
    return np.where(absent, np.nan, np.random.default_rng(seed).normal(size=COUNT))


SLOW, GAP = np.arange(COUNT) % 10 != 4, (TIME >= 3.0) & (TIME < 5.0)


@pytest.fixture
def found() -> Comparison:
    """A model of zeros, whose residual is white noise of the sensor's size."""
    measured = {"arm_angle": values(GAP), "strain_base": values(SLOW, 1)}
    zeros = {name: np.zeros(COUNT) for name in measured}
    one = Replay("run", TIME, measured, zeros, zeros, np.full(COUNT, 2))
    return Comparison(Arm.load("thesis"), [], [one], dict.fromkeys(measured, 1.0), 1.0, 1.0)


def test_a_line_connects_a_slow_sensor_and_breaks_in_a_gap():
    slow = values(SLOW)
    time, shown = where_measured(TIME, slow, slow)
    assert np.array_equal(time, TIME[~SLOW])
    assert np.isfinite(shown).all()
    time, shown = where_measured(TIME, values(GAP), values(GAP))
    (at,) = np.flatnonzero(np.isnan(shown))
    assert (time[at - 1], time[at]) == pytest.approx((3.0 - 1 / RATE, 5.0))
    _, shown = where_measured(TIME, values(SLOW | GAP), values(SLOW | GAP), points=150)
    assert np.isnan(shown).sum() == 1
    assert len(shown) <= 300
    whole = values(np.zeros(COUNT, dtype=bool))
    assert len(where_measured(TIME, whole, whole, POINTS)[1]) == POINTS


def test_each_second_has_the_error_of_its_readings(found):
    seconds = highlight.error_by_second(found.replays, found.noise)[0]
    assert seconds == pytest.approx([1.0] * 12, abs=0.4)
    zeros = {"arm_angle": np.zeros(COUNT)}
    only = Replay("run", TIME, {"arm_angle": values(GAP)}, zeros, zeros, np.zeros(COUNT, dtype=np.int64))
    assert np.isnan(highlight.error_by_second([only], found.noise)[0][3:5]).all()


def test_the_spectrum_of_white_noise_is_one_up_to_half_the_sensors_rate(found):
    for signal, end in (("arm_angle", 250.0), ("strain_base", 25.0)):
        frequency, size = residuals.amplitude(found, signal)
        assert frequency[-1] == pytest.approx(end, rel=0.03)
        assert np.sqrt(np.mean(size**2)) == pytest.approx(1.0, abs=0.15)


def test_a_slow_signal_is_the_worst_by_its_error_and_not_by_its_count(found):
    found.replays[0].measured["strain_base"] *= 2.0
    assert highlight.worst_signals(found) == ["strain_base", "arm_angle"]


def test_every_figure_of_a_recording_with_gaps_is_drawn(found):
    recording = Recording.from_arrays("run", TIME, "current", np.sin(TIME), found.replays[0].measured)
    drivers = {driver.name: driver for driver in residuals.drivers(found, [recording])}
    assert np.array_equal(np.isnan(drivers["arm angle"].values), GAP)
    for signal in found.noise:
        for driver in drivers.values():
            assert residuals.versus_driver(driver, found, found, signal).data
    drawn = overlays.signals(found.replays[0], None, found.noise).data
    lengths = {len(trace.y) for trace in drawn if trace.name == "measured"}
    assert lengths == {COUNT - GAP.sum() + 1, COUNT // 10}
    assert len(overlays.recorded(recording).data) == 3
    assert curves.overlay(found, found, "run", ("a", "b")).axes
