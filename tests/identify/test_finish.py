"""The last calibration, once a model was chosen: on all of the data, from where its errors are least."""

from __future__ import annotations

import numpy as np
import pytest

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
