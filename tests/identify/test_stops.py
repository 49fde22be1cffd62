"""Stops are found wherever a machine travels, and though they are touched once."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, diagnose, simulate


def test_a_stop_on_a_screw_is_named():
    """1 m stands for 1 rad, so that it travels a tenth of a radian: stops in the places of the thesis's arm would never touch."""
    model, time = Arm.load("emps"), np.arange(0.0, 8.0, 0.005)
    stops = {"stiffness": 2000.0, "upper": 0.035, "lower": -0.035, "damping_time": 0.0}
    machine, runs = model.with_effect("end_stop", **stops), []
    for seed, (frequency, force) in enumerate([(0.5, 80.0), (0.8, 120.0)]):
        wave = np.sin(2.0 * np.pi * frequency * time) * (1.0 + 0.3 * np.sin(1.1 * time))
        current = force / model.value("drive.torque_constant") * wave
        commands = Recording.from_arrays(f"run {seed}", time, "current", current, {"arm_angle": np.zeros(len(time))})
        runs.append(simulate(machine, commands, seed=seed))
    assert all(0.07 < np.ptp(run.signals["arm_angle"]) < 0.3 for run in runs)
    found = diagnose(model, runs)
    assert (found.verdict, found.effects) == ("effects", ["end_stop"])
    assert found.arm.effects["end_stop"]["upper"] == pytest.approx(stops["upper"], rel=0.05)
    assert found.arm.effects["end_stop"]["lower"] == pytest.approx(stops["lower"], rel=0.05)


@pytest.mark.parametrize(("push", "upper"), [(2.0, 2.3), (5.0, 5.3)])
def test_a_stop_that_ends_the_travel_once_far_from_zero_is_named(push, upper):
    """The recording touches it in the fitted part alone, and rests nowhere near the middle of a stop's usual places."""
    model, time = Arm.load("cu-rigid"), np.arange(0.0, 8.0, 0.01)
    stops = {"stiffness": 20.0, "upper": upper, "lower": upper - 9.0, "damping_time": 0.002}
    wave = 0.6 * np.sin(np.pi * time + 0.4 * np.sin(time + 1.0))
    voltage = wave + push * ((time > 0.2) & (time < 0.7))
    commands = Recording.from_arrays("run", time, "voltage", voltage, {"arm_angle": np.zeros(len(time))})
    run = simulate(model.with_effect("end_stop", **stops), commands, seed=1)
    touched = time[run.signals["arm_angle"] > upper]
    assert 0 < len(touched) < 20
    assert touched[-1] < 2.0
    found = diagnose(model, [run])
    assert (found.verdict, found.effects) == ("effects", ["end_stop"])
    assert found.arm.effects["end_stop"]["upper"] == pytest.approx(upper, rel=0.001)
