"""Sizes at which screening tries an effect: far too large a start must not hide a small effect."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env import Arm, simulate
from flexarm_env.identify.calibrate.objective import ObserverBank, objective_at
from flexarm_env.identify.calibrate.parameters import free_parameters
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.starts import changes_in_proportion

ARM = Arm.load("thesis-fem")
DATA = prepare(ARM, [simulate(ARM, "pulse", duration=4.0)])[1]
NUMBERS = DATA.settings.screening


def late_by(size: float) -> np.ndarray:
    """Change of the errors by a vibration whose phase an effect turns by `size`, with a true size of 1e-3."""
    time = np.linspace(0.0, 10.0, 500)
    return np.sin(time + 1e3 * size) - np.sin(time)


@pytest.fixture(scope="module")
def objective():
    return objective_at(ARM, DATA, free_parameters(ARM, ARM, DATA), 0.002, reduced=True)


def test_an_observer_for_a_large_start_does_not_judge_a_small_one(objective):
    """Gains for a tip inertia of 2e-4 kg m² make an arm with next to none run away."""
    large, none = (ARM.with_effect("tip_inertia", inertia=value) for value in (2e-4, 1e-9))
    without = objective.residual_of(ARM)
    shared = replace(objective, observers=ObserverBank())
    shared.residual_of(large)
    assert np.abs(shared.residual_of(none) - without).max() > 1.0
    assert np.abs(shared.residual_by_own_observers(none) - without).max() < 1e-4


@given(st.floats(0.02, 50.0))
def test_a_start_is_shrunk_until_its_change_points_to_the_errors_or_is_small(times):
    left = -late_by(1e-3)
    tried = changes_in_proportion(
        ARM, "tip_inertia", {"inertia": 1e-3 * times}, lambda values: late_by(values["inertia"]), left, DATA
    )
    sizes = [values["inertia"] for values, _ in tried]
    assert sizes[0] == 1e-3 * times
    assert all(later < earlier for earlier, later in pairwise(sizes))
    for _, change in tried[:-1]:  # each but the last called for a smaller one
        ratio = float(np.linalg.norm(change) / np.linalg.norm(left))
        assert ratio > 1.0 / NUMBERS.in_proportion or (ratio > 1.0 and change @ left > 0.0)
    if len(tried) < NUMBERS.shrinks:
        last = tried[-1][1]
        assert np.linalg.norm(last) <= np.linalg.norm(left) or last @ left <= 0.0


def test_a_size_that_turns_by_most_of_a_period_is_followed_by_one_that_explains_the_errors():
    left = -late_by(1e-3)
    (_, first), (values, last) = changes_in_proportion(
        ARM, "tip_inertia", {"inertia": 5e-3}, lambda values: late_by(values["inertia"]), left, DATA
    )
    assert first @ left > 0.0
    assert values["inertia"] == pytest.approx(5e-3 * NUMBERS.in_proportion)
    assert np.linalg.norm(left + last) < 0.6 * np.linalg.norm(left)


def test_an_effect_of_two_signs_is_taken_at_its_word():
    """A change for the worse means the other sign there."""
    left = np.array([1.0, -1.0])
    tried = changes_in_proportion(ARM, "constant_torque", {"torque": 1.0}, lambda _: left, left, DATA)
    assert len(tried) == 1
