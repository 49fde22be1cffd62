"""Derivatives of readings by parameters of effects, against differences of simulations: forces that vary with the motion."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate

INTERVAL = 0.005
TIME = INTERVAL * np.arange(160)

#: By effect: parameters that differ from the typical ones, and how close derivatives come to differences. Forces that vary with
#: the motion are found to some 1e-8 of themselves, which a difference over a narrow step enlarges.
EFFECTS = {
    "stribeck": ({}, 1e-6),
    "cogging": ({"phase": 0.3}, 1e-6),
    "position_friction": ({}, 1e-6),
    "load_friction": ({}, 1e-6),
    "friction_warmup": ({}, 1e-6),
    "presliding": ({}, 1e-5),
    "base_tilt": ({"uphill": 0.2}, 1e-6),
    "air_drag": ({}, 1e-6),
    "dead_zone": ({}, 1e-7),
    "saturation": ({"limit": 2.5}, 1e-7),
    "rate_limit": ({"rate": 15.0}, 1e-6),
    "tach_ripple": ({}, 1e-7),
    "pot_nonlinearity": ({}, 1e-7),
    "strain_drift": ({}, 1e-7),
    "time_offset": ({"offset": 0.007}, 1e-7),
    "payload": ({}, 1e-7),
    "backlash": ({}, 1e-7),
}


def swing(arm):
    """Build a command to the arm's drive."""
    command = 4.0 * np.sin(2 * np.pi * 0.9 * TIME) + 0.5
    return Recording.from_arrays("swing", TIME, arm.input, command, {"arm_angle": 0.0 * TIME})


def played(arm):
    """Readings (samples, signals) of the swing."""
    recording = simulate(arm, swing(arm), noise=False)
    return np.column_stack([recording.signals[signal] for signal in arm.signals])


def differences(arm, path):
    """Extrapolated central differences over the step at which two orders of them agree best, and how well."""
    best, width = np.zeros(0), np.inf
    scale = abs(arm.value(path)) or arm.parameter(path).typical or 1.0
    for step in 10.0 ** np.arange(-5.5, -1.9, 0.5) * scale:
        one, two, three = (
            (played(arm.with_values({path: arm.value(path) + h})) - played(arm.with_values({path: arm.value(path) - h})))
            / (2 * h)
            for h in (step, step / 2, step / 4)
        )
        once = (4 * two - one) / 3, (4 * three - two) / 3
        apart = np.max(np.abs(once[1] - once[0]))
        if apart < width:
            best, width = (16 * once[1] - once[0]) / 15, apart
    return best, width


@pytest.mark.slow(minutes=2)
@pytest.mark.parametrize("effect", EFFECTS)
def test_parameters_of_effects(effect):
    parameters, tolerance = EFFECTS[effect]
    arm = Arm.load("thesis").with_effect(effect, **parameters)
    names = [f"effects.{effect}.{key}" for key in arm.known[effect].parameters] + ["hub.inertia"]
    compare(arm, names, tolerance)


@pytest.mark.slow(minutes=2)
def test_the_load_of_a_late_command():
    """Friction follows the load of the command in effect, which changes within a sample, and of a ramp on its way."""
    arm = rigid_axis().with_effect("load_friction", coefficient=0.2).with_effect("input_delay", delay=0.0023)
    arm = arm.with_effect("rate_limit", rate=300.0)
    paths = ["load_friction.coefficient", "input_delay.delay", "rate_limit.rate", "coulomb.torque"]
    compare(arm, [f"effects.{path}" for path in paths] + ["hub.inertia"], 1e-6)


@pytest.mark.slow(minutes=2)
def test_the_load_of_a_drive_whose_back_emf_lowers_it():
    drive = {
        "input": "voltage",
        "torque_constant": 0.1,
        "resistance": 2.0,
        "gear_ratio": 10.0,
        "motor_inertia": 1e-3,
        "limit": 10.0,
    }
    arm = rigid_axis(drive).with_effect("load_friction", coefficient=0.2)
    compare(arm, ["effects.load_friction.coefficient", "drive.torque_constant", "hub.inertia"], 1e-6)


def rigid_axis(drive=None):
    drive = drive or {"input": "current", "torque_constant": 0.1, "gear_ratio": 10.0, "motor_inertia": 1e-3, "limit": 10.0}
    effects = {"viscous": {"coefficient": 0.1}, "coulomb": {"torque": 0.3}}
    return Arm.from_table({"drive": drive, "hub": {"inertia": 0.4}, "effects": effects, "sensors": {"arm_angle": {}}}, "axis")


def compare(arm, names, tolerance):
    """Compare the derivatives of readings by values of an arm with differences."""
    recording, slopes = simulate(arm, swing(arm), noise=False, derivatives=names)
    assert np.array_equal(np.column_stack([recording.signals[signal] for signal in arm.signals]), played(arm))
    for name in names:
        wanted, width = differences(arm, name)
        found = np.column_stack([slopes[name][signal] for signal in arm.signals])
        size = np.max(np.abs(wanted), axis=0)
        assert np.all(np.max(np.abs(found - wanted), axis=0) <= tolerance * size + 3 * width + 1e-8 * size.max()), name
