"""Values that the fitted part of recordings leaves undetermined are settled by the rest: constants, and those of effects."""

from __future__ import annotations

import contextlib
from dataclasses import replace

import numpy as np
import pytest
from searches import accept, far_off, model, scored

from flexarm_env import Arm, Recording, diagnose, fit, simulate
from flexarm_env.identify.calibrate import calibrator as module
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select import search as search_module
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.trace import Trace
from flexarm_env.identify.settings import SETTINGS

COULOMB, STICTION = 0.2, 0.08  # [Nm]
HELD = 0.26  # [Nm], between both models' static friction


def axis(stiction: float = STICTION) -> Arm:
    """Build a rigid axis whose friction is larger at rest."""
    drive = {"input": "torque", "limit": 4.0, "gear_ratio": 1.0}
    effects = {"viscous": {"coefficient": 0.05}, "coulomb": {"torque": COULOMB}, "stiction": {"extra": stiction}}
    sensors = {"arm_angle": {"resolution": 1e-4}, "motor_speed": {"noise": 0.02}}
    return Arm.from_table({"drive": drive, "hub": {"inertia": 0.02}, "effects": effects, "sensors": sensors}, "axis")


def recorded(machine: Arm, last: float = HELD) -> Recording:
    """Drive an axis for six seconds, so that it hardly rests, and then by one torque [Nm], from rest."""
    time = np.arange(0.0, 8.0, 0.004)
    command = 0.8 * np.sign(np.sin(2.0 * np.pi * 1.1 * time)) + 0.3 * np.sin(2.0 * np.pi * 0.37 * time)
    command[time > 6.0] = 0.0
    command[time > 6.5] = last
    asked = Recording.from_arrays("late", time, "torque", command, dict.fromkeys(machine.signals, np.zeros(len(time))))
    return simulate(machine, asked, seed=4)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return recorded(axis())


def test_static_friction_that_matters_only_in_the_rest_is_scanned(recording):
    nominal, data = prepare(axis(0.7 * STICTION), [recording])
    calibrator = Calibrator(nominal, data)
    found = calibrator.calibrate(nominal)
    assert calibrator.score(found.arm, held_out=False).windows < 1.1 < 3.0 < calibrator.score(found.arm).windows
    settled = calibrator.settle(found)
    assert calibrator.score(settled.arm).windows < 1.1
    assert settled.arm.value("effects.stiction.extra") > HELD - COULOMB
    assert calibrator.settle(settled) is settled


def test_a_model_that_lacks_an_effect_in_the_rest_is_to_blame():
    nominal, data = prepare(axis(), [recorded(axis().with_effect("saturation", limit=1.2), last=2.0)])
    calibrator = Calibrator(nominal, data)
    found = calibrator.calibrate(nominal)
    assert calibrator.score(found.arm, held_out=False).windows < 1.1 < 3.0 < calibrator.score(found.arm).windows
    assert calibrator.settle(found) is found


def test_a_final_calibration_that_loses_the_explanation_is_not_taken_and_widens_the_intervals(recording, monkeypatch):
    nominal, data = prepare(axis(), [recording])
    calibrator = Calibrator(nominal, data)
    found = calibrator.calibrate(nominal)
    final = calibrator.calibrate_on_all_data(found)
    away, refine = 0.3 * found.parameters.priors, module.refine

    monkeypatch.setattr(module, "refine", lambda objective, x: replace(refine(objective, x), x=x + away))
    kept = calibrator.calibrate_on_all_data(found)
    assert calibrator.score(final.arm).windows < 1.1
    assert kept.arm == found.arm
    assert np.all(kept.moved > 0.9 * away)
    assert kept.solution.residual == pytest.approx(kept.objective.residual_of(found.arm))


def test_nothing_is_said_to_be_missing(recording):
    assert diagnose(axis(0.7 * STICTION), [recording], jobs=1).verdict in ("parameters", "nothing_missing")


def test_a_fit_of_constants_alone_settles_them_too(recording):
    found = fit(axis(0.7 * STICTION), [recording], jobs=1)
    assert found.error["refitted"] < 1.1
    assert found.arm.value("effects.stiction.extra") > HELD - COULOMB


@pytest.mark.parametrize("seed", [4, 24])
def test_a_slow_axis_is_explained_though_its_error_is_a_step_in_static_friction(seed: int) -> None:
    machine = {"viscous": {"coefficient": 0.00343}, "coulomb": {"torque": 0.00392}, "stiction": {"extra": 0.001134}}
    model = {"viscous": {"coefficient": 0.003716}, "coulomb": {"torque": 0.003755}, "stiction": {"extra": 0.0008}}
    drive = {"input": "torque", "gear_ratio": 1.0, "motor_inertia": 0.0, "limit": 0.05}
    sensors = {"arm_angle": {"noise": 1e-4}, "motor_speed": {"noise": 5e-3}}
    true, given = (
        Arm.from_table({"drive": drive, "hub": {"inertia": inertia}, "effects": effects, "sensors": sensors}, "axis")
        for inertia, effects in ((0.0013315, machine), (0.0013827, model))
    )
    nominal, data = prepare(given, [simulate(true, "sweep", duration=8.0, rate=500.0, seed=seed)])
    calibrator, found = Calibrator(nominal, data).choose_hold_out()
    errors = [calibrator.score(found.arm, held_out).windows for held_out in (False, True)]
    assert max(errors) < 1.05
    assert found.arm.value("effects.stiction.extra") == pytest.approx(0.001134, rel=0.05)


LATE = Score(1.02, 1.6)  # windows at the noise, one free run beyond it
RIGHT = Score(1.01, 1.01)


def settled(monkeypatch, held: Score, fitted: Score, then: Score) -> Trace:
    """Settle a model with a limit of the command, of which a fit to all of the data leaves these errors."""
    search = far_off()
    search.calibrator.workers.threads = contextlib.nullcontext
    search.calibrator.calibrate_on_all_data = lambda calibration: calibration
    monkeypatch.setattr(search_module, "judge", lambda effects, *_: scored(then, *effects))
    rules = ThresholdCriteria(Score(2.1, 1.8), Score(2.0, 1.8), True, SETTINGS)
    found = replace(scored(held, "saturation"), fitted_score=fitted)
    return replace(search, criteria=rules).settle(accept(Trace.begin(model(error=2.0)), found, "saturation"))


def test_a_limit_that_is_reached_once_is_settled_by_the_held_out_part(monkeypatch):
    trace = settled(monkeypatch, LATE, RIGHT, RIGHT)
    assert [step.action for step in trace.steps] == ["calibrate", "accept", "settle"]
    assert trace.effects == ["saturation"]
    assert trace.model.score == trace.accepted[0].score == RIGHT
    assert trace.notes == [
        "nothing was held out of the last fit and its error: the held-out part alone determines a value of the model"
    ]


@pytest.mark.parametrize(
    ("held", "fitted", "then"),
    [
        (RIGHT, RIGHT, RIGHT),  # nothing is left to settle
        (Score(1.3, 1.6), RIGHT, RIGHT),  # windows of the held-out part show that something else is missing
        (LATE, Score(1.3, 1.05), RIGHT),  # and so do those of the fitted part,
        (LATE, Score(1.05, 1.3), RIGHT),  # or whole runs of it
        (LATE, RIGHT, LATE),  # no value explains everything
        (LATE, RIGHT, Score(1.3, 1.3)),
    ],
)
def test_a_model_that_fails_elsewhere_is_not_settled(monkeypatch, held, fitted, then):
    trace = settled(monkeypatch, held, fitted, then)
    assert [step.action for step in trace.steps] == ["calibrate", "accept"]
    assert trace.model.score == held
    assert trace.notes == []
