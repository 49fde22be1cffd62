"""The search by the density of forecasts: pairs of which neither stands out alone, and nothing where nothing is missing."""

from __future__ import annotations

from pathlib import Path

import pytest

from flexarm_env import Arm, Recording, compare, diagnose, simulate
from flexarm_env.identify.results import Diagnosis

#: A flexible arm without dry friction, whose tip is seen by a camera.
MODEL = """
name = "camera"
fixed = ["drive.torque_constant"]
[drive]
input = "voltage"
resistance = 4.2
limit = 10
torque_constant = 0.00768
gear_ratio = 70
motor_inertia = 0
[hub]
inertia = 0.002084179
[beam]
elements = 6
length = 0.419
mass_per_length = 0.15513
bending_stiffness = 0.1322
[sensors.arm_angle]
resolution = 0.00153398
[sensors.tip_deflection]
noise = 0.00015
[effects.viscous]
coefficient = 0.025
"""
PAIR = {"coulomb": 0.03, "constant_torque": -0.005}


@pytest.fixture(scope="module")
def camera(tmp_path_factory) -> Arm:
    path: Path = tmp_path_factory.mktemp("arm") / "camera.toml"
    path.write_text(MODEL)
    return Arm.load(path)


def machine_with(arm: Arm, torques: dict[str, float]) -> Arm:
    for name, torque in torques.items():
        arm = arm.with_effect(name, torque=torque)
    return arm


def search(arm: Arm, recording: Recording, jobs: int = 1) -> Diagnosis:
    return diagnose(arm, [recording], jobs=jobs)


@pytest.mark.slow(minutes=1)
@pytest.mark.parametrize("seed", [1, 2])
def test_two_missing_torques_are_named_where_one_other_effect_fits_better_than_either(camera, seed):
    """A cable's spring alone imitates both, at two to three times the noise; Coulomb friction alone leaves seventy times."""
    recording = simulate(machine_with(camera, PAIR), "square", duration=5.0, rate=500.0, seed=seed)
    found = search(camera, recording)
    assert found.verdict == "effects"
    assert set(found.effects) in ({"coulomb", "constant_torque"}, {"coulomb", "asymmetric_coulomb"})
    assert found.arm.value("effects.coulomb.torque") == pytest.approx(0.03, rel=0.05)
    # Three seconds leave constants uncertain by 0.2 of the noise on what is held out; the arm is calibrated on all of it.
    assert found.error["final"] < 1.2 < 50.0 < found.error["refitted"]
    assert next(row.error for row in compare(found.arm, [recording]).rows if row.recording == "all") < 1.02


def test_a_diagnosis_is_the_same_to_the_last_bit_in_threads():
    arm = Arm.load("cu-rigid")
    recording = simulate(machine_with(arm, {"coulomb": 0.05}), "square", duration=4.0, rate=100.0, seed=1)
    once, again = (search(arm, recording, jobs) for jobs in (1, 2))
    assert once.effects == ["coulomb"]
    assert once.trace == again.trace
    assert once.constants == again.constants


def test_nothing_is_named_where_nothing_is_missing(camera):
    found = search(camera, simulate(camera, "square", duration=5.0, rate=500.0, seed=4))
    assert (found.verdict, found.effects) == ("nothing_missing", [])
