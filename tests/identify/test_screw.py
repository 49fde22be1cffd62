"""A slide on a screw: 1 m stands for 1 rad, so that it travels a tenth of a radian."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, diagnose, simulate


def test_a_stop_on_a_screw_is_named():
    """Its travel is a twelfth of that of the thesis's arm: stops in the places that are usual there would never touch."""
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
