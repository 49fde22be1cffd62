"""Sound recordings have no fault, and every fault becomes plain data."""

from __future__ import annotations

import numpy as np
import pytest

import flexarm_env.demo
from flexarm_env import Arm, Recording, inspect_recordings, simulate
from flexarm_env.terminal.inputs import read_recordings
from tests.identify.inspect.faulty import changed


def test_every_fault_becomes_plain_data(thesis, square):
    clipped = changed(square, "strain_base", np.clip(square.signals["strain_base"], -1.5, 1.5))
    (plain,) = [fault.as_json() for fault in inspect_recordings(thesis, [clipped]).faults]
    expected = {"file": "square", "signal": "strain_base", "fault": "rail", "value": 1.5, "unit": "V"}
    assert expected.items() <= plain.items()
    assert len(plain["samples"]) <= 100


@pytest.mark.parametrize("name", ["thesis", "thesis-fem", "cu-flexible", "cu-rigid", "emps"])
@pytest.mark.parametrize("experiment", ["pulse", "square", "sweep"])
@pytest.mark.parametrize("noise", [True, False])
def test_a_simulated_machine_is_sound(name, experiment, noise):
    arm = Arm.load(name)
    run = simulate(arm, experiment, duration=4.0, rate=300.0, seed=8, noise=noise)
    assert inspect_recordings(arm, [run]).faults == ()


def test_the_shipped_recordings_are_sound():
    folder = flexarm_env.demo.__path__[0]
    found = inspect_recordings(Arm.load("thesis-fem"), Recording.read_all(folder))
    assert found.faults == ()
    assert {one.signal for one in found.signals} == {"arm_angle", "motor_speed", "strain_mid", "strain_base"}


@pytest.mark.parametrize(
    ("arm", "pattern"),
    [
        ("emps", "emps/*.mat"),
        ("cu-flexible", "cu_boulder/*flexarm*.txt"),
        ("cu-rigid", "cu_boulder/*rigidarm*.txt"),
        *(("thesis-fem", f"practice/p{i:02d}/*.csv") for i in range(1, 11)),
    ],
)
def test_measured_recordings_are_sound(measurements, arm, pattern):
    model = Arm.load(arm)
    files = sorted(measurements.glob(pattern))
    assert files
    assert inspect_recordings(model, read_recordings(model, files, None)).faults == ()
