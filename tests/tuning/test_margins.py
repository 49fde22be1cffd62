"""Margins against closed forms, and against what a delay and a gain do to the loop."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.pd import PD
from flexarm_env.errors import InputError
from flexarm_env.linear import linearise
from flexarm_env.tuning.margins import margins_from, margins_of, sensitivity

INTERVAL = 0.005
INERTIA, PUSH, FRICTION = 0.12, 0.495, 0.08


@pytest.fixture
def rigid() -> Arm:
    """A rigid arm J s² + b s under current, its two sensors without filters."""
    return Arm.from_table(
        {
            "drive": {"torque_constant": 0.33, "gear_ratio": 1.5, "motor_inertia": 0.0, "limit": 5.0},
            "hub": {"inertia": INERTIA},
            "sensors": {"arm_angle": {"noise": 1e-3}, "motor_speed": {"noise": 0.02}},
            "effects": {"viscous": {"coefficient": FRICTION}, "coulomb": {"torque": 0.1}},
        },
        "rigid",
    )


def closed_form(gains: tuple[float, float], rate: np.ndarray) -> np.ndarray:
    """PD on the zero-order hold of 1 / (J s² + b s): angle and speed from a held command, by hand."""
    a = FRICTION / INERTIA
    z, e = np.exp(1j * rate * INTERVAL), np.exp(-a * INTERVAL)
    speed = PUSH / FRICTION * (1.0 - e) / (z - e)
    angle = PUSH / FRICTION * ((INTERVAL - (1.0 - e) / a) * (z - e) + (1.0 - e) ** 2 / a) / ((z - 1.0) * (z - e))
    return gains[0] * angle + 1.5 * gains[1] * speed


def test_the_margins_of_pd_on_a_rigid_arm_are_those_of_the_closed_form(rigid) -> None:
    gains = (12.0, 1.3)
    found = margins_of(lambda arm: PD(arm, INTERVAL, *gains), rigid)
    cross = brentq(lambda rate: abs(closed_form(gains, rate)) - 1.0, 1.0, 300.0)
    lag = np.pi + np.angle(closed_form(gains, cross))
    assert found.phase == pytest.approx(np.rad2deg(lag), abs=0.05)
    assert found.delay == pytest.approx(lag / cross, rel=1e-3)
    # the phase crosses −180° at half the sampling rate only, where the loop is real
    assert (closed_form(gains, np.linspace(cross, 0.999 * np.pi / INTERVAL, 1000)).imag < 0.0).all()
    assert found.gain == pytest.approx(-1.0 / closed_form(gains, np.pi / INTERVAL).real, rel=1e-3)
    every = np.linspace(0.01, np.pi / INTERVAL, 200_000)
    assert found.modulus == pytest.approx(np.abs(1.0 + closed_form(gains, every)).min(), rel=1e-3)


def poles(arm: Arm, gains: tuple[float, float], late: int) -> float:
    """Largest size of the poles of PD with a command late by samples, by the eigenvalues of the whole loop."""
    model = linearise(arm.without_effect("coulomb").without_effect("stiction"), "moving", INTERVAL)
    angle, speed = (model.output[model.outputs.index(signal)] for signal in ("arm_angle", "motor_speed"))
    size = len(model.states)
    whole = np.zeros((size + late, size + late))
    whole[:size, :size] = model.transition
    law = -(gains[0] * angle + gains[1] * speed)
    if late:
        whole[:size, size] = model.response[:, 0]
        whole[size : size + late - 1, size + 1 :] = np.eye(late - 1)
        whole[-1, :size] = law
    else:
        whole[:size, :size] += np.outer(model.response[:, 0], law)
    return float(np.abs(np.linalg.eigvals(whole)).max())


def test_the_loop_stands_its_delay_margin_and_no_more() -> None:
    arm, gains = Arm.load("thesis"), (2.5308, 0.6625)
    margin = margins_of(lambda model: make_controller("pd", model, INTERVAL), arm).delay
    assert INTERVAL < margin < 2.0 * INTERVAL
    assert poles(arm, gains, 1) < 1.0
    assert poles(arm, gains, 2) > 1.0


def test_the_loop_stands_its_gain_margin_and_no_more() -> None:
    arm = Arm.load("thesis")
    margin = margins_of(lambda model: make_controller("pd", model, INTERVAL), arm).gain
    for factor in (0.98 * margin, 1.02 * margin):
        assert (poles(arm, (factor * 2.5308, factor * 0.6625), 0) < 1.0) == (factor < margin)


def test_margins_of_a_written_loop() -> None:
    """L = 2 / (s (1 + s)²): crossover and margins from its polynomial."""
    rates = np.linspace(1e-3, 60.0, 600_001)
    s = 1j * rates
    loop = 2.0 / (s * (1.0 + s) ** 2)
    found = margins_from(rates, loop, float(np.abs(1.0 + loop).min()))
    # the phase is −180° at 1 rad/s, where the gain is exactly 1
    assert found.gain == pytest.approx(1.0, abs=1e-3) or found.less_gain == pytest.approx(1.0, abs=1e-3)
    assert found.phase == pytest.approx(0.0, abs=0.01)
    half = margins_from(rates, 0.5 * loop, 1.0)
    assert half.gain == pytest.approx(2.0, rel=1e-4)


@pytest.mark.parametrize("name", ["pid_compensated", "lqg", "mpc", "vibration_high"])
def test_the_sensitivity_begins_at_one_and_ends(name) -> None:
    if name == "mpc":
        pytest.importorskip("daqp")
    arm = Arm.load("thesis").without_effect("coulomb").without_effect("stiction")
    found = sensitivity(make_controller(name, arm, INTERVAL), arm)
    assert found[0] == pytest.approx(1.0, abs=1e-6)
    assert np.abs(found[-100:]).max() < 1e-5


def test_an_unstable_loop_is_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="not stable") as error:
        margins_of(lambda arm: PD(arm, INTERVAL, 100.0, 10.0), Arm.load("thesis"))
    assert "\n" not in str(error.value)


def test_the_dead_time_of_the_arm_counts_to_the_loop() -> None:
    arm = Arm.load("thesis")
    late = arm.with_effect("input_delay", delay=INTERVAL)
    prompt, delayed = (margins_of(lambda model: make_controller("pd", model, INTERVAL), each).delay for each in (arm, late))
    assert prompt - delayed == pytest.approx(INTERVAL, abs=1e-4)


def delayed_closed_form(gains: tuple[float, float], rate: np.ndarray, samples: int, rest: float) -> np.ndarray:
    """PD on 1 / (J s² + b s) whose held command acts late by samples and a rest, by the modified z-transform by hand.

    From a held unit command the speed is S(t) = K (1 − e^(−a t)) and the angle A(t) = K (t − (1 − e^(−a t)) / a).
    """
    a, z = FRICTION / INERTIA, np.exp(1j * rate * INTERVAL)

    def speed_after(time: float) -> float:
        return PUSH / FRICTION * (1.0 - np.exp(-a * time))

    def angle_after(time: float) -> float:
        return PUSH / FRICTION * (time - (1.0 - np.exp(-a * time)) / a)

    new, decay, drift = INTERVAL - rest, np.exp(-a * INTERVAL), (1.0 - np.exp(-a * INTERVAL)) / a
    # over one sample: the older command for the rest, then the newer one
    older_speed = np.exp(-a * new) * speed_after(rest)
    older_angle = angle_after(rest) + speed_after(rest) * (1.0 - np.exp(-a * new)) / a
    command_to_speed = (speed_after(new) + older_speed / z) * z**-samples
    command_to_angle = (angle_after(new) + older_angle / z) * z**-samples
    speed = command_to_speed / (z - decay)
    angle = (command_to_angle + drift * speed) / (z - 1.0)
    return gains[0] * angle + 1.5 * gains[1] * speed


@pytest.mark.parametrize(("late", "samples", "rest"), [(1.5, 1, 0.5), (0.3, 0, 0.3), (2.0, 2, 0.0)])
def test_the_response_of_a_late_loop_is_that_of_the_closed_form(rigid, late: float, samples: int, rest: float) -> None:
    gains = (8.0, 0.9)
    moving = rigid.without_effect("coulomb").with_effect("input_delay", delay=late * INTERVAL)
    response = sensitivity(PD(moving, INTERVAL, *gains), moving)
    rates = np.linspace(2.0, 0.98 * np.pi / INTERVAL, 300)
    measured = response @ np.exp(-1j * np.outer(np.arange(len(response)), rates * INTERVAL))
    expected = 1.0 / (1.0 + delayed_closed_form(gains, rates, samples, rest * INTERVAL))
    np.testing.assert_allclose(measured, expected, rtol=2e-4)


def test_a_dead_time_of_one_and_a_half_samples_takes_as_much_from_the_delay_margin(rigid) -> None:
    late = rigid.with_effect("input_delay", delay=1.5 * INTERVAL)
    prompt, delayed = (margins_of(lambda arm: PD(arm, INTERVAL, 8.0, 0.9), arm).delay for arm in (rigid, late))
    assert prompt - delayed == pytest.approx(1.5 * INTERVAL, rel=0.01)
