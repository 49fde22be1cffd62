"""A sensor with a slow filter is late, and no clock is to blame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, inspect_recordings, simulate

DRIVE = {"input": "torque", "limit": 4.0, "gear_ratio": 1.0}
SENSORS = {"arm_angle": {"resolution": 1e-3}, "motor_speed": {"noise": 0.02}}
EFFECTS = {"viscous": {"coefficient": 0.05}, "coulomb": {"torque": 0.05}}


@pytest.fixture(scope="module")
def axis() -> Arm:
    return Arm.from_table({"drive": DRIVE, "hub": {"inertia": 0.02}, "effects": EFFECTS, "sensors": SENSORS}, "axis")


@pytest.fixture(scope="module")
def command() -> np.ndarray:
    time = np.arange(0.0, 8.0, 0.005)
    return 0.2 * np.sign(np.sin(2.0 * np.pi * 0.9 * time)) + 0.1 * np.sin(2.0 * np.pi * 0.31 * time**1.5)


def recorded(arm: Arm, command: np.ndarray) -> Recording:
    time = 0.005 * np.arange(len(command))
    asked = Recording.from_arrays("run", time, "torque", command, dict.fromkeys(arm.signals, np.zeros(len(time))))
    return simulate(arm, asked, seed=2)


@pytest.mark.parametrize("time", [0.05, 0.1, 0.2])
def test_a_filter_is_no_lag(axis, command, time):
    slow = recorded(axis.with_effect("tach_filter", time=time), command)
    assert inspect_recordings(axis, [slow]).faults == ()


@pytest.mark.parametrize("lag", [0.1, 0.2])
def test_a_lag_is_named(axis, command, lag):
    run = recorded(axis, command)
    samples = round(lag / 0.005)
    speed = np.r_[0.02 * np.random.default_rng(0).standard_normal(samples), run.signals["motor_speed"][:-samples]]
    (found,) = inspect_recordings(axis, [replace(run, signals={**run.signals, "motor_speed": speed})]).faults
    assert (found.kind, found.signal) == ("clock", "motor_speed")
    assert found.value == pytest.approx(lag, rel=0.1)
