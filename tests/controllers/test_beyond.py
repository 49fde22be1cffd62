"""Controllers beyond the thesis: shaping against closed forms, LQG's poles, payloads, what they gain on the plant."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from controllers.loop import INTERVAL, close, frictionless, loaded, slew

from flexarm_env.controllers import make_controller
from flexarm_env.controllers.estimator import Estimator
from flexarm_env.controllers.lqg import LQG
from flexarm_env.controllers.payload import PayloadEstimator
from flexarm_env.controllers.shaping import shaper_weights
from flexarm_env.errors import InputError
from flexarm_env.linear import linearise


def first_mode(plant):
    """Frequency [rad/s] and mass-normalised shape of the slowest vibration, from M and K alone."""
    squares, shapes = scipy.linalg.eigh(plant.model.stiffness, plant.model.mass)
    place = int(np.flatnonzero(squares > 1.0)[0])
    return np.sqrt(squares[place]), shapes[:, place]


def amplitude_after(arm, weights):
    """Amplitude of the first mode once a step of 1 A has come in parts, and that of a step at once, in closed form."""
    plant = frictionless(arm).plant(INTERVAL)
    frequency, shape = first_mode(plant)
    plant.place()
    plant.replay(np.append(np.cumsum(weights), np.full(40, np.sum(weights))))
    physical, size = plant.physical(), len(shape)
    moved, rate = (shape @ plant.model.mass @ part for part in (physical[:size], physical[size : 2 * size]))
    rests_at = shape[0] * arm.constants["drive"]["gear_ratio"] * arm.constants["drive"]["torque_constant"] / frequency**2
    return np.hypot(moved - rests_at, rate / frequency), abs(rests_at), frequency / (2.0 * np.pi)


def test_zero_vibration_leaves_none_at_the_exact_frequency(thesis):
    at_once, closed_form, frequency = amplitude_after(thesis, np.ones(1))
    assert at_once == pytest.approx(closed_form, rel=1e-9)
    for shaper in ("zv", "zvd"):
        left, whole, _ = amplitude_after(thesis, shaper_weights(shaper, frequency, 0.0, INTERVAL))
        assert left < 1e-9 * whole


@pytest.mark.parametrize("off", [0.9, 0.95, 1.05, 1.1])
def test_vibration_at_a_wrong_frequency_is_that_of_singer_and_seering(thesis, off):
    # the clamped frequency, so that steps fall on samples finely enough for the closed form of the continuous shaper
    _, _, frequency = amplitude_after(thesis, np.ones(1))
    ratio = 1.0 / off
    for shaper, power in (("zv", 1), ("zvd", 2)):
        left, whole, _ = amplitude_after(thesis, shaper_weights(shaper, frequency * off, 0.0, INTERVAL))
        assert left / whole == pytest.approx(abs(np.cos(0.5 * np.pi * ratio)) ** power, rel=0.05)


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.3])
@pytest.mark.parametrize("frequency", [1.225, 2.43, 8.96])
def test_shapers_are_exact_at_a_damped_pole_and_keep_the_target(frequency, damping):
    rate = 2.0 * np.pi * frequency * complex(-damping, np.sqrt(1.0 - damping**2))
    for shaper, zeros in (("zv", 1), ("zvd", 2)):
        weights = shaper_weights(shaper, frequency, damping, INTERVAL)
        powers = np.exp(-rate * INTERVAL * np.arange(len(weights)))
        assert weights.sum() == pytest.approx(1.0)
        for derivative in range(zeros):
            assert abs(np.sum(weights * np.arange(len(weights)) ** derivative * powers)) < 1e-9 * len(weights) ** derivative


def test_shaped_target_starts_where_the_arm_stands(thesis):
    controller = make_controller("shaped_zv", thesis, INTERVAL)
    controller.reset(1)
    shaped = [controller.shaped(np.array([[0.4, 0.0, 0.0, 0.0, 1.4]]))[0] for _ in range(60)]
    half = int(np.floor(0.5 / (2.429 * INTERVAL)))  # half a period of the clamped frequency
    np.testing.assert_allclose(shaped[: half - 1], 0.9, atol=0.02)
    np.testing.assert_allclose(shaped[half + 2 :], 1.4, atol=1e-9)


@pytest.mark.parametrize(("frequency", "damping"), [(0.0, 0.0), (80.0, 0.0), (2.0, 1.0), (np.nan, 0.0)])
def test_shaping_the_impossible_is_refused(frequency, damping):
    with pytest.raises(InputError):
        shaper_weights("zv", frequency, damping, INTERVAL)


@pytest.mark.parametrize("mass", [0.0, 0.05])
def test_lqg_is_stable_on_every_mode_of_the_arm(arm, mass):
    """The whole loop of the full arm, with modes and a payload that the design does not know."""
    controller = LQG(arm, INTERVAL)
    estimator, plant = controller.estimator, linearise(loaded(arm, mass), "moving", INTERVAL)
    size, seen = len(plant.states), estimator.size + 1
    direct = np.append(controller.gain, 0.0)
    correct = np.eye(seen) - estimator.gain @ estimator.output
    # state of the loop: arm, estimate before the readings, last command
    from_loop = np.hstack([estimator.gain @ plant.output, correct, -(estimator.gain @ estimator.direct)[:, None]])
    command = -direct @ from_loop
    loop = np.zeros((size + seen + 1,) * 2)
    loop[:size, :size] = plant.transition
    loop[:size] += np.outer(plant.response[:, 0], command)
    loop[size:-1] = estimator.transition @ from_loop + np.outer(estimator.response, command)
    loop[-1] = command
    assert np.abs(np.linalg.eigvals(loop)).max() < 1.0


def test_lqg_design_has_poles_inside(arm):
    controller = LQG(arm, INTERVAL)
    estimator = controller.estimator
    model = estimator.model
    regulated = model.transition - np.outer(model.response[:, 0], controller.gain)
    filtered = estimator.transition @ (np.eye(estimator.size + 1) - estimator.gain @ estimator.output)
    for matrix in (regulated, filtered):
        assert np.abs(np.linalg.eigvals(matrix)).max() < 0.999


def test_lqg_settles_without_offset_or_swing(arm):
    pd, lqg = (slew(arm, make_controller(name, arm, INTERVAL)) for name in ("pd", "lqg"))
    assert pd.settled() == np.inf
    assert lqg.settled() < 2.0
    assert np.abs(lqg.error[-400:]).max() < 0.6
    assert lqg.residual() < 0.8 * pd.residual()


def test_lqg_stands_a_dead_time_that_it_does_not_know(fine):
    run = slew(fine.with_effect("input_delay", delay=INTERVAL), make_controller("lqg", fine, INTERVAL))
    assert run.settled() < 2.0
    assert run.residual() < 0.1


def test_lqg_follows_a_square_wave(fine):
    time = np.arange(0.0, 10.0, INTERVAL)
    targets = np.deg2rad(50.0) * np.where(time % 5.0 < 2.5, 1.0, -1.0)
    run = close(fine, make_controller("lqg", fine, INTERVAL), targets)
    ends = np.round(np.arange(2.5, 10.1, 2.5) / INTERVAL).astype(int) - 1
    assert np.abs(run.error[ends]).max() < 1.0


def test_estimated_strain_and_speed_do_not_lag(arm):
    controller = make_controller("pd", arm, INTERVAL)
    estimator, shown, estimates, act = Estimator(arm, INTERVAL, 48.0), [], [], controller.act

    def spy(observation):
        if not shown:
            estimator.start(1)
        shown.append(observation[[1, 3]])
        estimator.correct(observation[None, :-1])
        estimates.append([estimator.reading(signal)[0] for signal in ("motor_speed", "strain_base")])
        command = act(observation)
        estimator.predict(np.array([float(command)]))
        return command

    controller.act = spy
    truth, shown, estimates = slew(arm, controller).truth[:, [1, 3]], shown, np.array(estimates)
    lags = range(-3, 4)
    errors = np.array([np.sqrt(np.mean((estimates[20 + k : 600 + k] - truth[20:600]) ** 2, axis=0)) for k in lags])
    raw = np.sqrt(np.mean((np.array(shown)[20:600] - truth[20:600]) ** 2, axis=0))
    assert [lags[place] for place in errors.argmin(axis=0)] == [0, 0]
    # no noisier than the gage, and than the tachometer
    assert errors[3, 1] < 1.1 * raw[1]
    assert errors[3, 0] < raw[0]


def pulse(arm):
    """Readings of a pulse of 3 A for half a second and what follows (thesis section 3.1)."""
    commands = np.zeros(1000)
    commands[100:200] = 3.0
    plant = arm.plant(INTERVAL)
    plant.place()
    truth = plant.replay(commands)
    noise = np.array([table["noise"] for table in arm.sensors.values()])
    step = np.array([table["resolution"] for table in arm.sensors.values()])
    return np.round((truth + noise * np.random.default_rng(3).standard_normal(truth.shape)) / step) * step


@pytest.mark.parametrize("mass", [0.0, 0.05, 0.1, 0.2, 0.3])
def test_payload_is_found_in_motion_and_at_rest(arm, mass):
    estimator = PayloadEstimator(arm, INTERVAL)
    estimator.start(1)
    history = []
    for readings in pulse(loaded(arm, mass)):
        estimator.update(readings[None])
        history.append(estimator.payload[0] if estimator.known[0] else np.nan)
    # half a period of the loaded arm (0.41 s) after the pulse has begun
    assert history[100 + round(0.41 / INTERVAL)] == pytest.approx(mass, rel=0.15, abs=0.01)
    assert history[-1] == pytest.approx(mass, rel=0.12, abs=0.01)


@pytest.mark.parametrize("mass", [0.0, 0.1, 0.3])
def test_payload_is_found_under_feedback(fine, mass):
    controller = make_controller("lqg_scheduled", fine, INTERVAL)
    slew(loaded(fine, mass), controller)
    assert controller.weigher.known.all()
    assert controller.weigher.payload[0] == pytest.approx(mass, rel=0.05, abs=0.01)


def test_payload_of_an_arm_at_rest_stays_unknown(thesis):
    estimator = PayloadEstimator(thesis, INTERVAL)
    estimator.start(3)
    draw = np.random.default_rng(0)
    for _ in range(1000):
        estimator.update(draw.normal(size=(3, 4)) * [0.002, 0.03, 0.01, 0.01])
    assert not estimator.known.any()
    np.testing.assert_array_equal(estimator.payload, 0.0)


def test_scheduling_takes_the_overshoot_of_a_payload(fine):
    heavy = loaded(fine, 0.3)
    fixed, scheduled = (slew(heavy, make_controller(name, fine, INTERVAL)) for name in ("lqg", "lqg_scheduled"))
    assert scheduled.error.max() < 0.3 * fixed.error.max()
    assert scheduled.settled() < fixed.settled()
