"""90 % intervals are as wide as the errors of the values, and wider where the model leaves more than the noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, fit, simulate
from flexarm_env.identify.calibrate.objective import unexplained_share
from flexarm_env.identify.settings import SETTINGS

NOISIER = 80.0
PATHS = ("hub.inertia", "effects.viscous.coefficient", "effects.coulomb.torque")


@pytest.fixture(scope="module")
def nominal() -> Arm:
    """A rigid axis whose torque constant is known, and with it the scale of forces."""
    arm = Arm.load("cu-rigid").with_effect("viscous", coefficient=0.05).with_effect("coulomb", torque=0.2)
    return replace(arm, fixed=("drive.torque_constant",), columns=None)


@pytest.fixture(scope="module")
def noisy(nominal) -> Arm:
    """The axis with sensors so noisy that values scatter by more than the exactness that no model exceeds."""
    sensors = {signal: {**sensor, "noise": NOISIER * sensor["noise"]} for signal, sensor in nominal.sensors.items()}
    return replace(nominal, sensors=sensors)


def fitted(nominal: Arm, machine: Arm, seed: int):
    """Fit the constants to a machine that moves under two commands."""
    runs = [simulate(machine, kind, duration=6.0, rate=200.0, seed=2 * seed + k) for k, kind in enumerate(("square", "sweep"))]
    return [one for one in fit(nominal, runs, jobs=1).estimates if one.path in PATHS]


def half_width(estimate) -> float:
    return 0.5 * (estimate.high - estimate.low) / estimate.value


def test_errors_over_half_widths_are_those_of_a_normal_distribution(noisy):
    over = []
    for seed in range(16):
        factors = np.exp(np.random.default_rng(seed).normal(0.0, 0.1, len(PATHS)))
        machine = noisy.with_values({path: factor * noisy.value(path) for path, factor in zip(PATHS, factors, strict=True)})
        found = fitted(noisy, machine, seed)
        over.append([(one.value / machine.value(one.path) - 1.0) / half_width(one) for one in found])
    assert np.shape(over) == (16, 3)
    assert np.std(over, axis=0) * SETTINGS.intervals.quantile == pytest.approx(1.0, abs=0.35)  # two standard errors of 16
    assert 0.8 <= np.mean(np.abs(over) < 1.0) <= 0.98


def test_values_of_a_wrong_model_are_less_certain_than_its_scatter(nominal):
    machine = nominal.with_effect("cable_stiffness", stiffness=0.3, rest_angle=0.1)
    right, wrong = fitted(nominal, nominal, 0), fitted(nominal, machine, 0)
    floor = SETTINGS.intervals.quantile * SETTINGS.intervals.best_model
    assert all(floor < half_width(one) < 1.2 * floor for one in right)
    assert all(half_width(one) > 0.8 * SETTINGS.intervals.quantile * SETTINGS.intervals.wrong_model for one in wrong)


@pytest.mark.parametrize(("error", "share"), [(0.9, 0.0), (1.0, 0.0), (2.0, 0.75), (10.0, 0.99)])
def test_what_noise_does_not_explain(error, share):
    assert unexplained_share(np.full((2, 3), error)) == pytest.approx(share)
