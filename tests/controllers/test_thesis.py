"""The thesis's controllers: their equations by hand, and what chapter 4 says of them on the plant."""

from __future__ import annotations

import numpy as np
import pytest
from controllers.loop import INTERVAL, close, frictionless, slew

from flexarm_env.controllers import make_controller
from flexarm_env.controllers.vibration import VibrationSuppression

TORQUE_CONSTANT, GEARS, GAGE = 0.33, 1.5, 2.27
COULOMB_MOTOR = 0.066 + 0.183 / 1.5  # thesis Table 2.1, motor side


def one_command(controller, angle=0.0, speed=0.0, mid=0.0, base=0.0, target=0.0):
    controller.reset()
    return float(controller.act(np.array([angle, speed, mid, base, target])))


def test_pd_is_equation_4_2(thesis):
    controller = make_controller("pd", thesis, INTERVAL)
    assert one_command(controller, angle=0.3, speed=0.7, target=1.0) == pytest.approx(2.5308 * 0.7 - 0.6625 * 0.7)


@pytest.mark.parametrize(("speed", "gain", "sign"), [(0.5, -1.0, 0.0), (-0.02, 1.0, -1.0), (0.029, 1.0, 1.0), (0.0, 1.0, 0.0)])
def test_dual_controller_is_equation_4_2_in_each_region(thesis, speed, gain, sign):
    moment = 0.8
    command = one_command(make_controller("vibration_dual", thesis, INTERVAL), speed=speed, base=GAGE * moment)
    torque = gain * moment / GEARS + sign * COULOMB_MOTOR
    assert command == pytest.approx(-0.6625 * speed + torque / TORQUE_CONSTANT)


def test_mid_beam_strain_stands_in_for_the_torque(thesis):
    command = one_command(make_controller("vibration_practical", thesis, INTERVAL), speed=1.0, mid=0.5)
    assert command == pytest.approx(-0.6625 - 1.18 * 0.5)


@pytest.mark.parametrize("delay", [0.0, 0.003, 0.005, 0.026, 0.074])
def test_delay_shifts_the_torque_between_samples(thesis, delay):
    controller = VibrationSuppression(thesis, INTERVAL, delay=delay, proportional=0.0, derivative=0.0)
    controller.reset(2)
    slopes = np.array([0.3, -1.1])
    for k in range(60):
        seen = np.zeros((2, 5))
        seen[:, 1], seen[:, 3] = 1.0, slopes * k * INTERVAL
        command = controller.act(seen)
    expected = -slopes * (59 * INTERVAL - delay) / (GAGE * GEARS * TORQUE_CONSTANT)
    np.testing.assert_allclose(command, expected, rtol=1e-9)


def test_rate_limit_holds_and_vanishes_once_reached(thesis):
    controller = make_controller("pd_rate_limited", thesis, INTERVAL, rate=20.0)
    controller.reset()
    commands = np.array([float(controller.act(np.array([0.0, 0.0, 0.0, 0.0, 1.0]))) for _ in range(40)])
    assert np.diff(commands, prepend=0.0).max() <= 20.0 * INTERVAL + 1e-12
    assert commands[-1] == pytest.approx(2.5308)


@pytest.fixture(scope="module")
def runs(thesis):
    names = ("pd", "vibration_dual", "vibration_low", "vibration_high", "vibration_practical")
    return {name: slew(thesis, make_controller(name, thesis, INTERVAL), noise=False) for name in names}


def test_pd_stops_short_and_swings(runs):
    # a calculation of its own in the thesis's notes: 91.7°, 0.053 V rms over the fifth second
    run = runs["pd"]
    assert 100.0 + run.error[-1] == pytest.approx(91.7, abs=0.3)
    assert np.sqrt(np.mean(run.truth[800:1000, 2] ** 2)) == pytest.approx(0.053, rel=0.1)
    # friction holds what P makes of the error: it cannot be more than static friction
    assert 2.5308 * np.deg2rad(abs(run.error[-1])) * GEARS * TORQUE_CONSTANT < 1.5 * 0.09487 + 0.21574


def test_what_section_4_5_says(runs):
    pd, dual, low, high, practical = runs.values()
    # combined: less vibration, more steady-state error
    assert dual.residual() < pd.residual()
    assert abs(dual.error[-1]) > abs(pd.error[-1])
    # low speed only: the error of PD alone, less vibration
    assert low.error[-1] == pytest.approx(pd.error[-1], abs=0.5)
    assert low.residual() < pd.residual()
    # high speed only, and its practical form: much less vibration, more error
    for run in (high, practical):
        assert run.residual() < 0.2 * pd.residual()
        assert abs(run.error[-1]) > abs(pd.error[-1])


def test_dual_controller_damps_with_noise_and_a_finer_beam(fine):
    pd, dual = (slew(fine, make_controller(name, fine, INTERVAL)) for name in ("pd", "vibration_dual"))
    assert dual.residual() < 0.6 * pd.residual()


def test_the_gain_taken_in_newton_metres_per_volt_swings_between_the_limits(thesis):
    run = slew(thesis, make_controller("vibration_practical", thesis, INTERVAL, torque_per_strain=1.18), noise=False)
    assert np.abs(run.commands[-200:]).max() == 5.0


@pytest.fixture(scope="module")
def pulse():
    feed = np.zeros(1000)
    feed[100:200] = 3.0  # thesis eq. 4.1, from 0.5 to 1.0 s
    return feed


def suppress(arm, gain, delay, pulse):
    """The arm after the pulse, under the term of eq. 4.1 alone."""
    options = {"proportional": 0.0, "derivative": 0.0, "friction_compensation": False}
    controller = VibrationSuppression(arm, INTERVAL, high_gain=gain, low_gain=gain, delay=delay, **options)
    return close(arm, controller, np.zeros(1000), noise=False, feed=pulse)


def without_dry_friction(arm):
    return frictionless(arm).with_effect("viscous", coefficient=arm.value("effects.viscous.coefficient"))


def test_delayed_torque_is_unstable_on_the_pinned_arm(thesis, pulse):
    # thesis section 4.1, Fig. 4.4: K_mo = −1, t_d = 0.026 s with friction; the first diverges
    run = suppress(thesis.with_values({"drive.limit": 0.0}), -1.0, 0.026, pulse)
    assert np.ptp(run.truth[-100:, 2]) > 1e6 * np.ptp(run.truth[100:200, 2])


def test_delayed_torque_goes_on_swinging_within_the_limit(thesis, pulse):
    # Figs. 4.5 and 4.6, of 5 A: it does not come to rest, and without dry friction it fills the limit
    run = suppress(thesis, -1.0, 0.026, pulse)
    assert np.ptp(run.truth[-100:, 2]) > 0.9 * np.ptp(run.truth[-300:-200, 2]) > 0.1
    run = suppress(without_dry_friction(thesis), -1.0, 0.026, pulse)
    assert run.commands[-100:].max() == 5.0
    assert run.commands[-100:].min() == -5.0


def test_torque_at_once_damps_the_frictionless_arm(thesis, pulse):
    # thesis section 4.2, Fig. 4.7: K_mo = −1, t_d = 0
    arm = without_dry_friction(thesis)
    with_control, without = (np.ptp(suppress(arm, gain, 0.0, pulse).truth[500:600, 2]) for gain in (-1.0, 0.0))
    assert with_control < 0.3 * without


def test_torque_at_once_does_not_damp_with_friction(thesis, pulse):
    # thesis section 4.3, Fig. 4.8
    run = suppress(thesis, -1.0, 0.0, pulse)
    assert np.ptp(run.truth[-100:, 2]) > 1.0
