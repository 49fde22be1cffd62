"""The frequency that a signal shows, against signals whose frequency is known."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env.thesis import arms, chapter3
from flexarm_env.thesis.frequency import over_time, vibration

TIME = np.arange(4000) / 1000.0


def damped(frequency, decay, amplitude=1.0, phase=0.3):
    return amplitude * np.exp(-decay * TIME) * np.cos(2 * np.pi * frequency * TIME + phase)


@pytest.mark.parametrize("frequency", [1.2, 2.43, 6.9, 8.94, 14.0])
def test_a_damped_sine_beside_a_trend_and_a_second_mode(frequency):
    signal = damped(frequency, 1.3, 0.4) + damped(24.0, 2.0, 0.2) + 3.0 * np.exp(-0.7 * TIME) - 1.0
    found = vibration(TIME, signal, 0.5, 2.5)
    assert found.frequency == pytest.approx(frequency, rel=1e-6)
    assert found.decay == pytest.approx(1.3, rel=1e-5)
    assert found.amplitude == pytest.approx(0.4 * np.exp(-1.3 * 0.5), rel=1e-5)


def test_the_stronger_of_two_in_the_band():
    signal = damped(3.0, 0.0, 1.0) + damped(9.0, 0.0, 0.4)
    assert vibration(TIME, signal, 0.0, 2.0).frequency == pytest.approx(3.0)
    assert vibration(TIME, signal, 0.0, 2.0, (5.0, 16.0)).frequency == pytest.approx(9.0)


def test_noise_of_a_percent_moves_it_little():
    noisy = damped(8.0, 0.5) + 0.01 * np.random.default_rng(0).standard_normal(len(TIME))
    assert vibration(TIME, noisy, 0.0, 2.0).frequency == pytest.approx(8.0, rel=0.01)


@pytest.mark.parametrize("signal", [np.zeros(4000), 2.0 - TIME, np.exp(-3.0 * TIME)])
def test_nothing_vibrates(signal):
    found = vibration(TIME, signal, 0.0, 2.0)
    assert np.isnan(found.frequency)
    assert found.amplitude == 0.0


def test_too_short_a_stretch_has_none():
    assert np.isnan(vibration(TIME, damped(3.0, 0.0), 0.0, 0.05).frequency)


def test_a_frequency_that_rises_is_followed():
    signal = np.sin(2 * np.pi * (6.0 * TIME + 0.5 * TIME**2))  # 6 Hz and 1 Hz more each second
    middle, found = over_time(TIME, signal, 0.3, 0.1)
    np.testing.assert_allclose(found, 6.0 + middle, rtol=0.05)


@pytest.mark.parametrize("model", ["combined", "coulomb", "pinned", "lighter", "heavier", "damped", "payload", "printed"])
def test_moving_signals_show_the_matrices_frequency(model):
    """Strain and speed of a moving hub vibrate as the linear arm does, whose dampings are known as well."""
    natural, ratio = chapter3.MODELS[model]().linearise("moving", 0.001).vibrations()
    for signal in ("strain_mid", "motor_speed"):
        found = chapter3.moving(model, signal)
        assert found.frequency == pytest.approx(natural[0] * np.sqrt(1.0 - ratio[0] ** 2), rel=1e-6)
        assert found.decay == pytest.approx(2 * np.pi * natural[0] * ratio[0], rel=1e-5)


@pytest.mark.parametrize("model", ["combined", "payload", "damped"])
def test_stuck_signals_show_the_matrices_frequency(model):
    natural, ratio = chapter3.MODELS[model]().linearise("stuck", 0.001).vibrations()
    assert chapter3.stuck(model).frequency == pytest.approx(natural[0] * np.sqrt(1.0 - ratio[0] ** 2), rel=1e-6)


def test_kelvin_voigt_damping_is_that_of_the_thesis_size():
    arm = arms.damped_beam(0.003)
    stuck = arm.linearise("stuck", 0.001).vibrations()
    # ratio = ω t/2 with t = 0.003 L/EI
    np.testing.assert_allclose(stuck[1], 2 * np.pi * stuck[0] * 0.003 / 7.911324 / 2, rtol=1e-9)
