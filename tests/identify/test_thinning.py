"""Recordings thinned to the rate that the arm needs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env import Arm, InputError, Recording, add, compare, fit, simulate
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.thinning import kept_samples, thin
from flexarm_env.identify.settings import SETTINGS


def rigid() -> Arm:
    return Arm.load("cu-rigid").with_effect("coulomb", torque=0.03).with_effect("viscous", coefficient=0.01)


@pytest.fixture(scope="module")
def sweep() -> Recording:
    """Of an axis whose loop is not replayed."""
    return replace(simulate(rigid(), "sweep", duration=8.0, rate=1000.0, seed=2), reference=None)


def test_a_rigid_axis_at_a_high_rate_is_thinned_and_a_note_says_so(sweep):
    _, data = prepare(rigid(), [sweep])
    assert data.interval > 1.5 * sweep.sample_time
    notes = [note for note in data.notes if note.startswith("thinned from 1000 to ")]
    assert len(notes) == 1
    assert f"{1.0 / data.interval:.4g} Hz" in notes[0]


def test_instants_stay_and_commands_keep_their_impulse(sweep):
    _, data = prepare(rigid(), [sweep], rate=250.0)
    run = data.runs[0]
    assert np.array_equal(run.time, sweep.time[::4])
    assert np.array_equal(run.measured[:, 0], sweep.signals["arm_angle"][::4])
    impulse = np.cumsum(sweep.command)[3::4]
    assert 4 * np.cumsum(run.command)[:-1] == pytest.approx(impulse[:-1])  # that of the last sample acts after the end
    assert len(run.intervals) == 0


@pytest.mark.parametrize("name", ["thesis", "thesis-fem"])
def test_the_thesis_keeps_its_500_hz(name):
    arm = Arm.load(name)
    still = Recording.from_arrays(
        "still", np.arange(0.0, 10.0, 0.002), "current", np.zeros(5000), dict.fromkeys(arm.signals, np.zeros(5000))
    )
    for run in (simulate(arm, "square", duration=4.0, rate=500.0), still):
        _, data = prepare(arm, [run])
        assert len(data.runs[0].time) == len(run)
        assert data.notes == ()


def test_a_replayed_control_law_keeps_its_rate():
    looped = simulate(rigid(), "sweep", duration=4.0, rate=1000.0, seed=2)
    assert rigid().controller is not None
    assert len(prepare(rigid(), [looped])[1].runs[0].time) == len(looped)


def test_a_short_lag_of_a_sensor_keeps_samples(sweep):
    arm = rigid()
    quick = {**arm.sensors, "motor_speed": {**arm.sensors["motor_speed"], "filter": 0.001}}
    _, data = prepare(replace(arm, sensors=quick), [sweep])
    assert len(data.runs[0].time) == len(sweep)


def test_stated_torque_noise_keeps_samples_and_refuses_a_rate(sweep):
    arm = rigid().with_values({"drive.torque_noise": 0.01})
    assert len(prepare(arm, [sweep])[1].runs[0].time) == len(sweep)
    with pytest.raises(InputError, match="torque_noise"):
        prepare(arm, [sweep], rate=250.0)


def test_a_rate_of_0_keeps_all_and_one_above_the_recording_is_refused(sweep):
    assert len(compare(rigid(), [sweep], rate=0).replays[0].time) == len(sweep)
    for rate in (2000.0, -1.0, float("nan")):
        with pytest.raises(InputError, match="1000 Hz"):
            prepare(rigid(), [sweep], rate=rate)
    with pytest.raises(InputError, match="leaves 8 samples"):
        prepare(rigid(), [sweep], rate=1.0)


def test_a_sensor_slower_than_the_rows_keeps_samples(sweep):
    slow = sweep.signals["motor_speed"].copy()
    slow[1::2] = np.nan
    recording = replace(sweep, signals={**sweep.signals, "motor_speed": slow})
    kept, notes = thin(rigid(), [recording], np.ones(2), SETTINGS, None)
    assert len(kept[0]) == len(sweep)
    assert notes == []


@given(seed=st.integers(0, 10_000), factor=st.integers(2, 9))
def test_steps_stay_within_their_length_and_gaps_stay(seed, factor):
    draws = np.random.default_rng(seed)
    steps = draws.uniform(0.8, 1.2, 300)
    steps[draws.integers(20, 280, 3)] = 50.0
    time = np.cumsum(steps)
    kept = kept_samples(time, float(factor))
    assert (np.diff(kept) > 0).all()
    taken = np.diff(time[kept])
    assert ((taken <= factor + 0.6) | (np.diff(kept) == 1)).all()
    for gap in np.flatnonzero(np.diff(time) > 20.0):
        assert {gap, gap + 1} <= set(kept.tolist()) or gap + 1 >= kept[-1]


def test_constants_and_error_agree_with_those_of_all_samples(sweep):
    model = rigid().with_values({"hub.inertia": 1.2 * rigid().value("hub.inertia")})
    whole, thinned = fit(model, [sweep], rate=0), fit(model, [sweep])
    assert any(note.startswith("thinned") for note in thinned.notes)
    assert thinned.error["refitted"] == pytest.approx(whole.error["refitted"], abs=0.05)
    for one, other in zip(whole.estimates, thinned.estimates, strict=True):
        assert one.low <= other.value <= one.high, one.path


@pytest.mark.parametrize("samples", [999, 1000, 1499])
def test_a_short_recording_keeps_enough_samples(sweep, samples):
    (run,) = prepare(rigid(), [sweep.part(0.0, (samples - 0.5) * sweep.sample_time)])[1].runs
    assert len(run.time) >= SETTINGS.thinning.fewest_samples
    assert (len(run.time) < samples) == (samples >= 2 * SETTINGS.thinning.fewest_samples)


def test_break_away_within_a_step_keeps_samples():
    time = np.arange(0.0, 6.0, 0.001)
    runs = []
    for late in (0, 2):  # the command steps at a kept sample, or in the middle of a step
        command = np.where((time + 1e-9) % 1.0 < 0.5, 0.0, 6.0 * np.sign(np.sin(2.0 * np.pi * time / 2.0) + 0.1))
        played = Recording.from_arrays("steps", time, "voltage", np.roll(command, late), {}, require_signal=False)
        runs.append(simulate(rigid(), played, seed=1))
    aligned, between = (prepare(rigid(), [run])[1].interval for run in runs)
    assert aligned == pytest.approx(0.004)
    assert between < 0.003


@pytest.mark.parametrize(("effect", "parameter", "size"), [("input_delay", "delay", 0.006), ("current_lag", "time", 0.01)])
def test_a_delay_of_the_usual_size_is_measured_in_thinned_recordings(effect, parameter, size):
    arm = rigid()
    run = simulate(arm.with_effect(effect, **{parameter: size}), "sweep", duration=6.0, rate=1000.0, seed=4)
    found = add(effect, arm, [run], rate=250.0)
    assert found.arm.value(f"effects.{effect}.{parameter}") == pytest.approx(size, rel=0.1)
    assert found.error["final"] < 1.1


def test_a_rate_that_leaves_no_reading_of_a_signal_is_refused():
    arm = Arm.load("cu-rigid")
    run = simulate(arm, "square", duration=2.0, rate=1000.0, name="run")
    speed = run.signals["motor_speed"].copy()
    speed[::2] = np.nan
    odd = replace(run, signals=run.signals | {"motor_speed": speed})
    with pytest.raises(InputError, match="rate 250 Hz leaves no reading of motor_speed in run"):
        prepare(arm, [odd], rate=250.0)
