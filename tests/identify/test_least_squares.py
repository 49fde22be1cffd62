"""Minimisation: closed forms, and goals that are out of reach."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from flexarm_env import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.calibrate.least_squares import Ending, Goal, StepSizes, covariance, minimise, one_by_one
from flexarm_env.identify.calibrate.objective import objective_at
from flexarm_env.identify.calibrate.parameters import free_parameters
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.settings import SETTINGS

Floats = NDArray[np.float64]
JACOBIANS = 6


def curved_valley(floor: float) -> Callable[[Floats], Floats]:
    """Rosenbrock's function as a residual (Comput. J. 3 (1960) 175), above a floor that nothing lowers."""
    return lambda x: np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0], floor])


def minimised(floor: float, most: float = np.inf) -> tuple[float, int]:
    """Minimise from Rosenbrock's start under a goal: the squares that are left, and the number of replays."""
    valley, calls = curved_valley(floor), []

    def residual(x: Floats) -> Floats:
        calls.append(x)
        return valley(x)

    steps, goal = StepSizes(*(np.full(2, 1e-4),) * 3), Goal(lambda left: float(left @ left), most)
    numbers = replace(SETTINGS.least_squares, steps=1)
    found = minimise(one_by_one(residual), np.array([-1.2, 1.0]), np.full(2, 1e6), steps, numbers, Ending(40, 1e-6, goal))
    return float(found.residual @ found.residual), len(calls)


def test_a_linear_residual_ends_at_its_closed_form():
    rng = np.random.default_rng(0)
    slopes, offset, prior = rng.normal(size=(20, 3)), rng.normal(size=20), np.array([0.5, 1.0, 2.0])
    steps = StepSizes(*(np.full(3, 0.1),) * 3)
    residuals, ending = one_by_one(lambda x: slopes @ x + offset), Ending(JACOBIANS, 1e-12)
    found = minimise(residuals, np.zeros(3), prior, steps, SETTINGS.least_squares, ending)
    exact = -np.linalg.solve(slopes.T @ slopes + np.diag(prior**-2.0), slopes.T @ offset)
    assert found.x == pytest.approx(exact, abs=1e-6)


@pytest.mark.parametrize(("reached", "now", "left", "out"), [(9.0, 5.0, 1, False), (9.0, 5.0, 0, True), (5.1, 5.0, 30, True)])
def test_a_goal_is_out_of_reach_where_steps_as_helpful_as_the_last_do_not_lead_there(reached, now, left, out):
    goal = Goal(lambda residual: float(residual[0]), 1.5)
    assert goal.is_out_of_reach(np.array([reached]), np.array([now]), left) is out


def test_a_minimisation_goes_on_to_a_goal_that_it_reaches():
    assert minimised(0.1, most=1.0) == minimised(0.1)
    assert minimised(0.1)[0] == pytest.approx(0.01, abs=1e-3)


def test_a_minimisation_ends_early_where_its_goal_is_out_of_reach():
    left, replays = minimised(5.0, most=1.0)
    assert left > 25.0
    assert replays < minimised(5.0)[1] / 2


def test_what_a_residual_leaves_over_noise_is_the_excess_of_its_own_weights():
    machine = Arm.load("thesis").with_effect("cable_stiffness", stiffness=0.2)
    nominal, dataset = prepare(Arm.load("thesis"), [simulate(machine, "square", duration=3.0, rate=200.0, seed=2)])
    plain = objective_at(nominal, dataset, free_parameters(nominal, nominal, dataset), 0.01)
    objective = plain.weighted_by(nominal)
    left = objective.square_over_noise(objective.residual_of(nominal))
    assert left == pytest.approx(objective.excess_factor**2)
    assert left > 2.0


def test_two_values_that_show_only_together_keep_their_priors_apart():
    """Their sum is known to 1e-9 of a prior, their difference as well as both priors say: half a variance each."""
    column = np.full(100, 1e9)
    spread = covariance(np.stack([column, column], axis=1), np.ones(100), np.array([2.0, 2.0]), block=1)
    np.testing.assert_allclose(spread, [[2.0, -2.0], [-2.0, 2.0]], rtol=1e-4)
