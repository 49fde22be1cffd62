"""The noise of a sensor, estimated from its readings, against noise that was put into them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env.recordings.noise import Noise, Readings, estimate_noise
from flexarm_env.recordings.resolution import distinct_readings, find_resolution

SIGMA = 2e-3
MOTIONS = ("rest", "swing", "starts and stops", "vibration", "decay")
#: Steps of the readings. At rest in one place, those of a coarse sensor scatter by its distance to the next step.
STEPS = (0.0, 0.5 * SIGMA, SIGMA, 4.0 * SIGMA)
CASES = [(motion, step) for motion in MOTIONS for step in STEPS if motion != "rest" or step <= SIGMA]


def motions(time: np.ndarray) -> dict[str, np.ndarray]:
    """Motions of a sensor's quantity, up to a thousand times the noise."""
    speed = np.where(np.sin(2.0 * time) > 0.3, np.sin(5.0 * time), 0.0)  # a hub that sticks and breaks away
    return {
        "rest": np.full_like(time, 0.3),
        "swing": np.sin(3.0 * time),
        "starts and stops": np.cumsum(speed) * time[1],
        "vibration": 0.5 * np.sin(2.0 * np.pi * 24.0 * time) + np.sin(time),
        "decay": np.exp(-0.3 * time) * np.sin(2.0 * np.pi * 7.0 * time),
    }


def estimated(time: np.ndarray, values: np.ndarray) -> Noise:
    found = estimate_noise([Readings(time, values)])
    assert found is not None
    return found


@pytest.mark.parametrize("rate", [100.0, 250.0, 1000.0])
@pytest.mark.parametrize(("motion", "step"), CASES)
def test_the_noise_is_found_in_any_motion(rate, motion, step):
    time = np.arange(0.0, 10.0, 1.0 / rate)
    noise = np.random.default_rng(7).normal(0.0, SIGMA, len(time))
    values = motions(time)[motion] + noise
    if step:
        values = np.round(values / step) * step
    found = estimated(time, values)
    assert found.total == pytest.approx(np.hypot(SIGMA, step / 12**0.5), rel=0.15)
    if step and len(np.unique(values)) > 2:
        assert found.resolution == pytest.approx(step, rel=1e-6)


def test_noise_in_uneven_samples_with_gaps_spikes_and_missing_ones():
    draws = np.random.default_rng(3)
    time = np.cumsum(draws.uniform(0.7, 1.3, 5000)) * 0.002
    time[2500:] += 1.0
    values = np.sin(4.0 * time) + draws.normal(0.0, SIGMA, len(time))
    values[::400] += 0.5
    values[100:160] = np.nan
    values[1::7] = np.nan
    assert estimated(time, values).total == pytest.approx(SIGMA, rel=0.1)


@pytest.mark.parametrize("rows", [2.0, 3.0, 10.0, 10.0 / 3.0])
@pytest.mark.parametrize("step", [0.0, 2.0 * SIGMA])
def test_readings_of_a_slow_sensor_are_taken_once(rows, step):
    time = np.arange(0.0, 40.0, 0.002)
    first = np.unique(np.ceil(np.arange(0.0, len(time), rows)).astype(int))
    first = first[first < len(time)]
    values = np.sin(time[first]) + np.random.default_rng(5).normal(0.0, SIGMA, len(first))
    if step:
        values = step * np.round(values / step)
    held = values[np.searchsorted(first, np.arange(len(time)), side="right") - 1]
    rows_that_count = np.flatnonzero(distinct_readings(held))
    late = 2 if rows % 1.0 else 0  # the row of a coarse reading that did not change is known to some
    assert np.abs(rows_that_count[:, None] - first).min(axis=1).max() <= late
    assert len(rows_that_count) == pytest.approx(len(first), rel=0.02)
    assert estimated(time, held).total == pytest.approx(np.hypot(SIGMA, step / 12**0.5), rel=0.15)


def test_each_change_of_a_slow_sensor_without_a_beat_counts():
    random = np.random.default_rng(7)
    held = random.integers(5, 60, 800)  # rows for which each reading is held; no number of them is common
    values = random.normal(0.0, 1.0, len(held))
    counts = np.flatnonzero(distinct_readings(np.repeat(values, held)))
    assert counts.tolist() == [0, *np.cumsum(held)[:-1].tolist()]


@pytest.mark.parametrize("share", [0.4, 0.02])
def test_a_coarse_sensor_is_not_taken_for_a_slow_one(share):
    time = np.arange(0.0, 10.0, 0.002)
    values = np.round(np.random.default_rng(2).normal(0.3, share, len(time)))
    assert distinct_readings(values).all()


def test_noise_that_is_larger_in_motion_is_given_for_both():
    time = np.arange(0.0, 20.0, 0.002)
    moves = time > 10.0
    noise = np.random.default_rng(1).normal(0.0, SIGMA, len(time)) * np.where(moves, 3.0, 1.0)
    found = estimated(time, np.where(moves, np.sin(5.0 * time), np.sin(50.0)) + noise)
    assert found.rest == pytest.approx(SIGMA, rel=0.1)
    assert found.moving == pytest.approx(3.0 * SIGMA, rel=0.1)


def test_predicted_motion_is_taken_off():
    time = np.arange(0.0, 10.0, 0.01)
    shaken = np.cumsum(np.random.default_rng(4).normal(0.0, 5.0 * SIGMA, len(time)))  # as fast as noise, but motion
    values = shaken + np.random.default_rng(5).normal(0.0, SIGMA, len(time))
    raw, predicted = Readings(time, values), Readings(time, values, shaken)
    assert estimate_noise([raw]).total > 2.0 * SIGMA
    assert estimate_noise([raw, predicted]).total == pytest.approx(SIGMA, rel=0.1)


def test_signals_without_noise_give_none():
    time = np.arange(0.0, 1.0, 0.01)
    assert estimate_noise([Readings(time, np.full_like(time, 2.0))]) is None
    assert estimate_noise([Readings(time[:30], np.sin(time[:30]))]) is None
    assert estimate_noise([Readings(time, np.full_like(time, np.nan))]) is None


@given(factor=st.floats(1e-8, 1e8), seed=st.integers(0, 1000))
def test_noise_scales_with_the_unit(factor, seed):
    time = np.arange(0.0, 4.0, 0.01)
    values = np.sin(3.0 * time) + np.random.default_rng(seed).normal(0.0, SIGMA, len(time))
    one, other = estimated(time, values), estimated(time, factor * values)
    assert other.total == pytest.approx(factor * one.total, rel=1e-6)


@given(speed=st.floats(-5.0, 5.0), acceleration=st.floats(-5.0, 5.0), seed=st.integers(0, 1000))
def test_steady_acceleration_leaves_the_noise(speed, acceleration, seed):
    time = np.arange(0.0, 4.0, 0.01)
    noise = np.random.default_rng(seed).normal(0.0, SIGMA, len(time))
    motion = speed * time + acceleration * time**2
    windows = [Readings(time, values).windows() for values in (noise, noise + motion)]
    assert windows[1].variance() == pytest.approx(windows[0].variance(), rel=1e-6)


@given(step=st.floats(1e-9, 1e3), offset=st.floats(-3.0, 3.0), seed=st.integers(0, 100))
def test_the_step_of_a_converter_is_found(step, offset, seed):
    counts = np.random.default_rng(seed).integers(-200, 200, 300)
    assert find_resolution(step * (counts + offset)) == pytest.approx(step, rel=1e-6)


def test_the_step_is_found_where_a_file_rounds_it():
    counts = np.random.default_rng(0).integers(-800, 800, 4000)
    step = 2.0 * np.pi / 4096
    assert find_resolution(np.round(counts * step, 4)) == pytest.approx(step, rel=1e-3)


def test_readings_without_a_grid_have_no_step():
    assert find_resolution(np.random.default_rng(0).normal(size=4000)) == 0.0
    assert find_resolution(np.array([])) == 0.0


@pytest.mark.parametrize("step", [4.192745350063109e-06, 1.7e-4, 0.3])
def test_a_coarse_reading_that_stands_still_but_where_it_moves_fast_has_no_noise(step):
    """Too few windows move fast to count, and in the others nothing changes."""
    time = np.arange(0.0, 5.0, 0.01)
    moved = np.where(time > 2.0, 3000.0 * (1.0 - np.cos(2.0 * (time - 2.0))), 0.0)
    assert estimated(time, step * np.round(moved)).deviation == 0.0
