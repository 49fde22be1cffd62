"""Derivatives of simulated readings by the names of constants."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, InputError, Recording, simulate

INTERVAL = 0.005
TIME = INTERVAL * np.arange(160)
SWING = Recording.from_arrays("swing", TIME, "current", 4.0 * np.sin(2 * np.pi * 0.9 * TIME) + 0.5, {"arm_angle": 0.0 * TIME})


@pytest.mark.slow(minutes=2)
def test_a_short_name_is_that_of_an_effect():
    arm = Arm.load("thesis")
    _, slopes = simulate(
        arm, SWING, noise=False, derivatives=["coulomb.torque", "effects.coulomb.torque", "sensors.arm_angle.gain"]
    )
    recording = simulate(arm, SWING, noise=False)
    angle = recording.signals["arm_angle"]
    assert np.array_equal(slopes["coulomb.torque"]["arm_angle"], slopes["effects.coulomb.torque"]["arm_angle"])
    assert np.allclose(slopes["sensors.arm_angle.gain"]["arm_angle"], angle / arm.value("sensors.arm_angle.gain"), atol=1e-9)
    assert np.abs(slopes["sensors.arm_angle.gain"]["motor_speed"]).max() < 1e-9


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("hub.inertja", "no constant 'hub.inertja'"),
        ("beam.elements", "no derivative by beam.elements"),
        ("sensors.arm_angle.noise", "no derivative by sensors.arm_angle.noise"),
        ("backlash.gap", "effect is absent"),
        ("sensors.arm_angle.filter", "at which the arm changes its kind"),
    ],
)
def test_a_constant_without_derivatives_is_refused(name, message):
    arm = Arm.load("thesis").with_effect("backlash", gap=0.0)
    with pytest.raises(InputError, match=message):
        simulate(arm, SWING, derivatives=[name])
