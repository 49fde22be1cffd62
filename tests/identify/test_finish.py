"""The last calibration, once a model was chosen: on all of the data, from where its errors are least."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexarm_env.identify.calibrate.calibrator as module
from flexarm_env import Arm, simulate
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.settings import SETTINGS


def calibrated(machine: Arm) -> tuple[Calibrator, Calibration]:
    """Calibrate the thesis's arm to two recordings of a machine."""
    arm = Arm.load("thesis")
    calibrator = Calibrator(
        *prepare(arm, [simulate(machine, kind, seed=3, duration=5.0, rate=200.0) for kind in ("square", "pulse")])
    )
    return calibrator, calibrator.calibrate(calibrator.nominal)


def largest_error(calibrator: Calibrator, arm: Arm) -> float:
    return max(calibrator.score(arm, held_out).windows for held_out in (False, True))


def test_near_the_noise_one_calibration_on_all_of_the_data_is_the_last():
    machine = Arm.load("thesis").with_values({"hub.inertia": 0.13})
    calibrator, found = calibrated(machine)
    once, finished = calibrator.calibrate_on_all_data(found), calibrator.finish(found)
    assert largest_error(calibrator, finished.arm) < 1.1
    assert finished.arm == once.arm
    assert finished.moved == pytest.approx(once.moved)


@pytest.mark.parametrize(("effect", "size"), [("cable_stiffness", {"stiffness": 1.5}), ("backlash", {"gap": 0.2})])
def test_far_off_the_end_of_least_error_is_the_last_and_as_uncertain_as_it_moved(effect, size):
    calibrator, found = calibrated(Arm.load("thesis").with_effect(effect, **size))
    once, finished = calibrator.calibrate_on_all_data(found), calibrator.finish(found)
    errors = [largest_error(calibrator, one.arm) for one in (found, once, finished)]
    assert errors[0] > SETTINGS.errors.far_off
    assert errors[2] <= errors[1]
    moved = np.abs(finished.parameters.position(found.arm) - finished.solution.x)
    assert np.all(finished.moved >= moved)


def test_far_off_a_calibration_that_ends_worse_is_not_taken(monkeypatch):
    calibrator, found = calibrated(Arm.load("thesis").with_effect("cable_stiffness", stiffness=1.5))
    refine, ends = module.refine, []

    def refine_badly(objective, x):
        refined = refine(objective, x)
        ends.append(refined.x + 2.0 * found.parameters.priors)
        return replace(refined, x=ends[-1])

    monkeypatch.setattr(module, "refine", refine_badly)
    kept = calibrator.calibrate_on_all_data(found)
    assert largest_error(calibrator, found.arm) > SETTINGS.errors.far_off
    assert largest_error(calibrator, kept.arm) == largest_error(calibrator, found.arm)
    assert kept.arm == found.arm
    assert np.all(kept.moved >= np.abs(ends[0] - found.parameters.position(found.arm)))
