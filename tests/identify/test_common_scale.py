"""The scale of torques, inertias and stiffness: no motion shows it, so priors set it, or a known payload."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, simulate
from flexarm_env.identify.calibrate import refine as module
from flexarm_env.identify.calibrate.common_scale import (
    along_scale,
    best_scale,
    force_power,
    force_powers,
    rescale,
    scale_deviation,
)
from flexarm_env.identify.calibrate.least_squares import cost_of, one_by_one
from flexarm_env.identify.calibrate.objective import Objective, objective_at
from flexarm_env.identify.calibrate.parameters import FitParameters, free_parameters
from flexarm_env.identify.calibrate.refine import Refined, gauss_newton, refine
from flexarm_env.identify.calibrate.refine import _End as End
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.settings import SETTINGS


@pytest.mark.parametrize(
    ("unit", "power"),
    [("N*m", 1), ("kg/m", 1), ("Nm/A", 1), ("N*s**2/m**3", 1), ("V/N/m", -1), ("rad/(N*m)", -1), ("rad/s", 0), ("V", 0), ("", 0)],
)
def test_how_a_unit_goes_with_forces(unit, power):
    assert force_power(unit) == power


def objective_of(nominal: Arm, data: Dataset) -> Objective:
    """Of free replays, weighted by the nominal arm's errors."""
    return objective_at(nominal, data, free_parameters(nominal, nominal, data), 0.0).weighted_by(nominal, narrow_priors=False)


def problem_of(payload=0.0):
    """The nominal arm against its own motion under a pulse, with a payload that the recording states."""
    arm = Arm.load("thesis-fem").with_effect("cable_stiffness", stiffness=0.1, rest_angle=0.2)
    machine = arm.with_effect("payload", mass=payload) if payload else arm
    recording = replace(simulate(machine, "pulse", duration=3.0, rate=200.0, seed=1), conditions={"payload": payload})
    nominal, data = prepare(arm, [recording])
    problem = objective_of(nominal, data)
    return problem, problem.parameters.position(nominal), force_powers(nominal, problem.parameters)


def deviation_of(problem, x, powers, others=0.0):
    """Of the scale's logarithm, where a value beside it changes the residual by a share of what the scale changes it."""
    along, prior = along_scale(problem, x, powers), problem.weights.prior
    slopes = np.outer(along.residual, others * (powers == 0)) if along.is_open else np.zeros((1, len(x)))
    slopes = along.correct(slopes)
    return scale_deviation(along, problem.parameters, x, np.linalg.inv(slopes.T @ slopes + np.diag(prior**-2.0)))


def test_motion_is_the_same_on_every_scale():
    problem, x, powers = problem_of()
    other = rescale(problem.parameters, x, powers, 0.3)
    arm = problem.parameters.apply(problem.arm, other)
    for path, power in (("hub.inertia", 1), ("effects.cable_stiffness.stiffness", 1), ("sensors.strain_mid.gain", -1)):
        assert arm.value(path) == pytest.approx(np.exp(0.3 * power) * problem.arm.value(path), rel=1e-12)
    assert arm.value("effects.cable_stiffness.rest_angle") == problem.arm.value("effects.cable_stiffness.rest_angle")
    np.testing.assert_allclose(problem.residual(other), problem.residual(x), atol=1e-6)


def test_priors_set_a_scale_that_nothing_else_does():
    problem, x, powers = problem_of()
    found = best_scale(problem, rescale(problem.parameters, x, powers, 0.2), powers)
    # the priors' centres are the nominal arm's values, at x = 0
    np.testing.assert_allclose(found, x, atol=1e-4)
    along, priors = along_scale(problem, x, powers), np.array([c.prior for c in problem.parameters])
    assert along.of_priors == pytest.approx(np.sum((powers / priors) ** 2), rel=1e-3)
    assert along.residual @ along.residual < 1e-3 * along.of_priors


@pytest.mark.parametrize("wrong", [0.3, 1.0, 2.0])
def test_a_scale_is_as_uncertain_as_the_constants_prove_wrong(wrong):
    problem, x, powers = problem_of()
    draw, slope = np.random.default_rng(0), powers / problem.weights.prior**2
    off = []
    for _ in range(100):
        true = np.where(powers, wrong * problem.weights.prior * draw.standard_normal(len(x)), x)
        shift = -(slope @ true) / (slope @ powers)  # to the best scale, where all is as near to the nominal arm as can be
        off.append(shift / deviation_of(problem, rescale(problem.parameters, true, powers, shift), powers))
    # where all proves nearly right, the constant that stands for what few cannot show keeps the deviation wide
    assert 0.6 < np.sqrt(np.mean(np.square(off))) < 1.25


def test_a_scale_that_all_constants_agree_on_is_known_the_better():
    problem, x, powers = problem_of()
    by_priors_alone = np.sum((powers / problem.weights.prior) ** 2) ** -0.5
    # torque constant, two inertias, gears, three of friction, two of the beam, two gages
    assert deviation_of(problem, x, powers) == pytest.approx(by_priors_alone / np.sqrt(11), rel=0.02)


def test_a_known_payload_sets_the_scale():
    problem, x, powers = problem_of(payload=0.15)
    found = best_scale(problem, x, powers)
    assert deviation_of(problem, x, powers) < 0.002
    assert np.abs(found - x).max() < 0.005


def test_a_payload_that_another_value_makes_up_for_does_not_set_the_scale():
    problem, x, powers = problem_of(payload=0.15)
    unknown, xu, pu = problem_of()
    assert deviation_of(problem, x, powers, others=1.0) == pytest.approx(deviation_of(unknown, xu, pu), rel=0.1)


def test_a_known_torque_constant_leaves_no_scale():
    problem, x, _ = problem_of()
    rest = FitParameters(tuple(p for p in problem.parameters if p.path != "drive.torque_constant"))
    powers = force_powers(problem.arm, rest)
    assert not powers.any()
    assert deviation_of(problem, x, powers) == 0.0


def test_the_last_stretch_ends_where_the_normal_equations_say():
    draw = np.random.default_rng(0)
    matrix = draw.standard_normal((30, 4)) * np.array([1e4, 1.0, 1e-3, 1.0])
    matrix[:, 3] = matrix[:, 1]  # these two show together only
    aim, prior = draw.standard_normal(30), np.array([0.1, 0.2, 0.3, 0.4])
    found = gauss_newton(one_by_one(lambda x: matrix @ x - aim), np.array([0.3, -0.2, 0.1, 0.5]), prior, SETTINGS.refining).x
    exact = np.linalg.solve(matrix.T @ matrix + np.diag(prior**-2.0), matrix.T @ aim)
    np.testing.assert_allclose(found, exact, atol=1e-6)


def test_a_fit_settles_where_inertia_was_shared_wrongly_between_motor_and_hub():
    problem, x, _ = problem_of()
    paths = [c.path for c in problem.parameters]
    motor, hub = paths.index("drive.motor_inertia"), paths.index("hub.inertia")
    there = x.copy()
    there[motor] += 0.1
    arm_side = problem.arm.constants["drive"]["gear_ratio"] ** 2 * problem.arm.value("drive.motor_inertia")
    there[hub] = np.log(1.0 - arm_side * (np.exp(0.1) - 1.0) / problem.arm.value("hub.inertia"))
    found = refine(problem, there).x
    before, after, true = (cost_of(problem.residual(at), at, problem.weights.prior) for at in (there, found, x))
    assert before > true + 100.0
    assert after <= true  # noise has its own idea of the truth


def test_a_fit_of_the_torque_constant_alone_settles():
    problem, x, _ = problem_of()
    place = [c.path for c in problem.parameters].index("drive.torque_constant")
    parameters = FitParameters((problem.parameters.items[place],))
    alone = replace(problem, parameters=parameters, weights=replace(problem.weights, prior=parameters.priors))
    np.testing.assert_allclose(refine(alone, np.array([0.02])).x, x[place], atol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("wrong", [0.0, 1.0])
@pytest.mark.parametrize("seed", [2, 3, 6, 8])  # where other ways down end up to 209 above the truth, or at twice its cost
def test_a_fit_that_ends_in_a_hollow_finds_the_next(seed, wrong):
    arm = Arm.load("thesis-fem")
    nominal, data = prepare(arm, [simulate(arm, "square", duration=4.0, rate=200.0, seed=seed)])
    problem = objective_of(nominal, data)
    rough = ("drive.gear_stiffness", "drive.motor_", "hub.inertia", "effects.")
    widths = np.array([wrong * (0.6 if c.path.startswith(rough) else 0.1) * c.prior for c in problem.parameters])
    x = problem.parameters.position(nominal)
    found = refine(problem, x + widths * np.random.default_rng(seed).standard_normal(len(x))).x
    after, true = (cost_of(problem.residual(at), at, problem.weights.prior) for at in (found, x))
    assert after <= true


@pytest.mark.parametrize(("rough", "counts"), [(1.0005, [0.0, 0.02]), (1.005, [0.0, 0.02, 0.06]), (1.02, [0.0, 0.06])])
def test_values_are_as_uncertain_as_minima_alike_scatter(monkeypatch, rough, counts):
    """Those of much larger errors are left out, and where two differ a third is sought."""
    problem, x, powers = problem_of()
    along = np.where(powers == 0, problem.weights.prior, 0.0)
    ends = iter([(0.0, 1.0), (0.02, rough), (0.06, 1.0)])

    def descend(objective, start, levels):
        away, error = next(ends)
        jacobian = np.eye(len(problem.residual(x)), len(x))
        found = Refined(x + away * along, error * problem.residual(x), error**2, jacobian)
        return [End(objective, found)] * (1 + bool(levels))

    monkeypatch.setattr(module, "_descend", descend)
    monkeypatch.setattr(module, "_along_scale", lambda objective, found, powers: found)
    found = refine(problem, x)
    np.testing.assert_array_equal(found.x, x)
    beside = powers == 0  # each minimum is moved to its best scale
    np.testing.assert_allclose(found.scatter[beside], np.std(counts, ddof=1) * along[beside], atol=1e-12)
