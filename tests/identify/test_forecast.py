"""Forecasts: their predicted spread is that of a machine under random torques, and the disturbances found are those put in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.density import first_disturbances, likeliest, predict
from flexarm_env.identify.replay.forecast import Disturbances, filtered_states, window_samples

RATE = 100.0


@pytest.fixture(scope="module")
def arm() -> Arm:
    """A hub without friction, so that its motion is linear."""
    return Arm.load("cu-rigid")


def torque_per_volt(arm: Arm) -> float:
    """Torque on the hub [Nm/V] at rest."""
    drive = arm.constants["drive"]
    return drive["torque_constant"] * drive["gear_ratio"] / drive["resistance"]


def shaken(arm: Arm, torque: float, duration: float = 60.0, noise: float = 1.0, seed: int = 1) -> Recording:
    """A motion under a torque on the hub, new in each sample, that no recorded command shows.

    Args:
        arm: of the machine.
        torque: its standard deviation [Nm].
        duration: [s].
        noise: of the sensors, over that which the arm states.
        seed: of both.
    """
    draw = np.random.default_rng(seed)
    time = np.arange(0.0, duration, 1.0 / RATE)
    command = 2.0 * np.sin(2.0 * np.pi * 0.7 * time) + np.sin(2.0 * np.pi * 2.3 * time)
    shaking = torque / torque_per_volt(arm) * draw.standard_normal(len(time))
    sensors = {name: {**values, "noise": noise * values["noise"]} for name, values in arm.sensors.items()}
    played = Recording.from_arrays("shaken", time, "voltage", command + shaking, {}, require_signal=False)
    return replace(simulate(replace(arm, sensors=sensors), played, seed=seed), command=command)


def data_of(arm: Arm, *recordings: Recording) -> Dataset:
    return prepare(arm, recordings, rate=0.0)[1]


@pytest.mark.parametrize("torque", [0.0003, 0.003, 0.03])
def test_the_predicted_spread_is_the_scatter_under_random_torques(arm, torque):
    data = data_of(arm, shaken(arm, torque))
    found = predict(arm, data, Disturbances(torque, (1.0,) * len(data.signals)))
    squares = found.leads.mean_squares(found.errors)
    windows = len(found.errors) / window_samples(data)
    # errors of a window are hardly independent at late lead times, so that each window counts as one reading there
    bound = 4.0 * np.sqrt(2.0 / windows)
    there = found.leads.counts > 0.0
    assert there.any(axis=0).all()
    np.testing.assert_allclose((squares / found.variance)[there], 1.0, atol=bound)


def test_forecasts_scatter_more_the_longer_they_are_and_the_larger_the_torque(arm):
    data = data_of(arm, shaken(arm, 0.003, duration=5.0))
    small, large = (predict(arm, data, Disturbances(torque, (1.0,) * len(data.signals))) for torque in (0.003, 0.03))
    angle = data.signals.index("arm_angle")
    assert (np.diff(small.variance[:, angle]) > 0.0).all()
    assert (large.variance > small.variance).all()


@pytest.mark.parametrize(("torque", "noise"), [(0.002, 0.5), (0.002, 1.0), (0.02, 1.0)])
def test_the_likeliest_disturbances_predict_as_those_put_in(arm, torque, noise):
    """Torques are tried in steps, so that variances are known to within a step and its square."""
    data = data_of(arm, shaken(arm, torque, duration=30.0, noise=noise))
    found = likeliest(arm, data, first_disturbances(arm, data))
    true = predict(arm, data, Disturbances(torque, (noise**2,) * len(data.signals)))
    step = data.settings.forecasts.torque_step
    assert torque / step < found.disturbances.torque < step * torque
    there = found.leads.counts > 0.0
    assert (np.abs(np.log(found.variance / true.variance))[there] < np.log(step**2)).all()


def test_the_true_torque_is_likelier_than_others(arm):
    data = data_of(arm, shaken(arm, 0.01, duration=20.0))
    ones = (1.0,) * len(data.signals)
    costs = [predict(arm, data, Disturbances(torque, ones)).cost for torque in (0.0025, 0.01, 0.04)]
    assert min(costs) == costs[1]


def test_an_absent_reading_has_no_error_and_no_weight(arm):
    whole = shaken(arm, 0.005, duration=20.0)
    angle = whole.signals["arm_angle"].copy()
    angle[::3] = np.nan
    data = data_of(arm, replace(whole, signals={**whole.signals, "arm_angle": angle}))
    found = predict(arm, data, Disturbances(0.005, (1.0,) * len(data.signals)))
    column = data.signals.index("arm_angle")
    absent = np.isnan(data.fitted[0].measured[:, column])
    assert 0.3 < absent.mean() < 0.4
    assert (found.errors[absent, column] == 0.0).all()
    assert found.leads.counts[:, column].sum() == (~absent).sum()
    assert found.leads.counts[:, 1 - column].sum() == len(absent)
    squares = found.leads.mean_squares(found.errors)
    bound = 4.0 * np.sqrt(2.0 * window_samples(data) / len(absent))
    there = found.leads.counts > 0.0
    np.testing.assert_allclose((squares / found.variance)[there], 1.0, atol=bound)


def test_each_payload_has_groups_of_its_own():
    arm = Arm.load("thesis-fem")
    loaded = arm.with_effect("payload", mass=0.15)
    runs = [simulate(a, "pulse", duration=2.0, rate=200.0, seed=seed) for seed, a in enumerate((arm, loaded))]
    runs = [replace(run, conditions={"payload": mass}) for run, mass in zip(runs, (0.0, 0.15), strict=True)]
    nominal, data = prepare(arm, runs, rate=0.0)
    found = predict(nominal, data, Disturbances(0.001, (1.0,) * len(data.signals)))
    half = len(found.leads.counts) // 2
    assert found.leads.counts[:half].sum() == found.leads.counts[half:].sum() == found.errors.size / 2
    assert (found.variance[:half] != found.variance[half:]).any()
    alone = predict(nominal, replace(data, runs=data.runs[1:]), found.disturbances)
    np.testing.assert_array_equal(alone.errors, found.errors[len(found.errors) // 2 :])


def test_forecasts_from_kept_states_are_those_of_the_whole_recording(arm):
    data = data_of(arm, shaken(arm, 0.005, duration=10.0))
    found = predict(arm, data, Disturbances(0.005, (1.0,) * len(data.signals)))
    states = filtered_states(arm, data, found.observer, most=10)
    assert states.rows.sum() <= 10 * window_samples(data)
    np.testing.assert_array_equal(states.errors(arm), found.errors[states.rows])
    # an arm that moves differently errs differently, from the same states
    assert (states.errors(arm.with_effect("viscous", coefficient=0.05)) != found.errors[states.rows]).any()
