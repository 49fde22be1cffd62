"""The bounds by which a step is known to hold no event."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env import Arm, simulate
from flexarm_env.plant.crossing import chord_error

thousandths = st.integers(-1000, 1000).map(lambda count: count / 1000)


@given(st.floats(-2.0, 8.0), st.floats(-5.0, -2.0), thousandths, thousandths, thousandths, thousandths)
def test_a_decay_bends_its_rows_by_no_more_than_its_bound(rate, length, u, v, x, y):
    """A block ṗ = P, Ṗ = −c₁ P + f that moves at ṗ = x, Ṗ = y, by its closed form."""
    c1, length = 10.0**rate, 10.0**length
    t = np.linspace(0.0, length, 200)
    decayed = -np.expm1(-c1 * t)
    row = u * ((x + y / c1) * t - y / c1**2 * decayed) + v * y / c1 * decayed
    chord = row[-1] * t / length
    scale = np.abs(row).max() + (abs(u * x) + abs(u * y) / c1 + abs(v * y) / c1) * length + abs(y) / c1**2
    assert np.abs(row - chord).max() <= abs(u - v * c1) * abs(y) * chord_error(0.0, c1, length) * (1 + 1e-6) + 1e-12 * scale


@pytest.mark.parametrize("damping_time", [1e-3, 3e-2])
def test_a_stiff_gear_that_is_damped_far_beyond_its_vibration_stops_and_breaks_away_as_a_rigid_one(damping_time):
    arm = Arm.load("thesis")
    square = simulate(arm, "square", duration=6.0, noise=False)
    soft = simulate(arm.with_effect("gear_compliance", stiffness=3e6, damping_time=damping_time), square, noise=False)
    assert np.abs(soft.signals["arm_angle"] - square.signals["arm_angle"]).max() < 1e-6 * np.ptp(square.signals["arm_angle"])
