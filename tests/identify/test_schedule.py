"""Levels of process noise: what one of them moves astray does not end the calibration of a model that lacks nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.schedule import Schedule
from flexarm_env.identify.replay.dataset import prepare

COULOMB = 0.03  # [Nm]
PATH = "effects.coulomb.torque"


@pytest.fixture(scope="module")
def calibrator() -> Calibrator:
    """Prepare a recording of a rigid arm, and a model whose friction is off by 0.2 %: twice the noise over seconds."""
    arm = Arm.load("cu-rigid").with_effect("coulomb", torque=COULOMB)
    recording = simulate(arm, "square", duration=4.0, rate=200.0, seed=1)
    return Calibrator(*prepare(arm.with_values({PATH: 1.002 * COULOMB}), [recording]))


def lead_astray(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the first level end where friction is half as large again, and errors be so rough that nothing leads back."""
    minimise, ends = Schedule._minimise, []

    def stray(self, objective, x, *args, **kwargs):
        found = minimise(self, objective, x, *args, **kwargs)
        is_friction = np.array([parameter.path == PATH for parameter in self.parameters])
        if not ends:
            ends.append(found.x + np.log(1.5) * is_friction)
            return replace(found, x=ends[0])
        return replace(found, x=x, residual=objective.residual(x)) if np.array_equal(x, ends[0]) else found

    monkeypatch.setattr(Schedule, "_minimise", stray)


def test_a_rival_that_a_level_led_astray_goes_on_from_where_it_began(calibrator, monkeypatch):
    lead_astray(monkeypatch)
    found = calibrator.calibrate_rival(calibrator.nominal)
    assert found is not None
    assert calibrator.score(found.arm).windows < 1.05 < calibrator.score(calibrator.nominal).windows
    assert found.arm.value(PATH) == pytest.approx(COULOMB, rel=1e-3)


def test_a_rival_that_began_far_off_does_not(calibrator, monkeypatch):
    lead_astray(monkeypatch)
    assert calibrator.calibrate_rival(calibrator.nominal.with_values({PATH: 0.9 * COULOMB})) is None
