"""Appendix A's methods on recordings whose constants are known, and where they go wrong."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env.thesis import appendix
from flexarm_env.thesis.constants import MOTOR_COULOMB, MOTOR_VISCOUS


@pytest.mark.parametrize("speed", [55.87, 40.82, 20.0])
@pytest.mark.parametrize("inertia", [0.0012, 0.00193])
def test_the_model_s_run_down_is_eq_1(speed, inertia):
    time, curve = appendix.run_down(speed, inertia)
    b, T_f = MOTOR_VISCOUS, MOTOR_COULOMB
    exact = np.maximum(-T_f / b + (speed + T_f / b) * np.exp(-b / inertia * time), 0.0)
    np.testing.assert_allclose(curve, exact, atol=1e-9)


@pytest.mark.parametrize("inertia", [0.0012, 0.00193])
def test_three_methods_find_the_inertia_and_the_printed_slope_does_not(inertia):
    found = appendix.inertias(48.3, inertia)
    for method in ("stopping time", "slope with Coulomb torque", "whole curve"):
        assert found[method] == pytest.approx(inertia, rel=0.01)
    # without the Coulomb torque, too small by the viscous part of the whole torque
    share = MOTOR_VISCOUS * 48.3 / (MOTOR_COULOMB + MOTOR_VISCOUS * 48.3)
    assert found["slope as printed"] == pytest.approx(share * inertia, rel=0.01)


def test_the_whole_curve_withstands_noise():
    time, curve = appendix.run_down(55.87, 0.00193, noise=0.05, seed=3)
    viscous, inertia = appendix.fit_run_down(time, curve, MOTOR_COULOMB)
    assert inertia == pytest.approx(0.00193, rel=0.01)
    assert viscous == pytest.approx(MOTOR_VISCOUS, rel=0.05)


def test_stopping_time_and_coulomb_torque_are_each_other_s_inverse():
    inertia = appendix.inertia_from_stopping(55.87, 0.714, 0.0011, 0.11)
    assert appendix.coulomb_from_stopping(55.87, 0.714, 0.0011, inertia) == pytest.approx(0.11, rel=1e-12)


def test_the_energy_balance_is_exact_without_noise_and_biased_with_it():
    line, noisy = appendix.energy_balance(), appendix.energy_balance(noise=0.03)
    assert (line.slope, line.intercept) == pytest.approx((0.188, 0.1018 / 1.5**2), rel=1e-4)
    assert np.abs(line.residual).max() < 1e-5
    assert noisy.slope < 0.99 * line.slope


def test_a_faster_ramp_reads_no_less():
    slow, fast = appendix.static_torque(0.05), appendix.static_torque(0.5)
    exact = (1.5 * 0.09487 + 0.21574) / 1.5
    assert exact <= slow < exact + 2e-4
    assert slow <= fast < exact + 2e-3
