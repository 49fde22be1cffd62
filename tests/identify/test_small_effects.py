"""Machines that move freely under far more torque than what they lack: friction of a millionth of the drive's torque."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.objective import objective_at
from flexarm_env.identify.calibrate.parameters import FitParameter, FitParameters, free_parameters
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score
from flexarm_env.identify.replay.initial_state import find_start
from flexarm_env.identify.replay.observer import innovation_noise, observer_gains
from flexarm_env.identify.select.model import judge
from flexarm_env.identify.settings import SETTINGS

FRICTION, PULL = 2e-6, -1e-5  # [Nm], where the drive gives 0.5 Nm
STEP = 8e-7  # [rad], of the encoder


def carriage(**effects: float) -> Arm:
    """Build a body that a motor moves without friction, with torques that a model of it may lack."""
    drive = {"input": "torque", "limit": 4.0, "gear_ratio": 1.0}
    sensors = {"arm_angle": {"resolution": STEP}}
    arm = Arm.from_table({"drive": drive, "hub": {"inertia": 0.15}, "sensors": sensors}, "carriage")
    for name, torque in effects.items():
        arm = arm.with_effect(name, torque=torque)
    return arm


def pushed(arm: Arm, phase: float, hertz: float) -> Recording:
    """Record an arm under a command that drives it hard from the first sample on, with what a noisy loop adds."""
    time = np.arange(0.0, 5.0, 1.0 / 250.0)
    command = 0.5 * np.cos(2.0 * np.pi * hertz * time + phase) + 0.02 * np.random.default_rng(5).standard_normal(len(time))
    angle = dict.fromkeys(arm.signals, np.zeros(len(time)))
    asked = Recording.from_arrays(f"run-{hertz:g}", time, "torque", command, angle)
    return simulate(arm, asked, seed=3)


@pytest.fixture(scope="module")
def recordings() -> list[Recording]:
    machine = carriage(coulomb=FRICTION, constant_torque=PULL)
    return [pushed(machine, 0.0, 0.8), pushed(machine, 1.0, 1.7)]


def test_an_arm_that_is_driven_hard_at_once_is_met_at_rest(recordings):
    """Speeds estimated from the first samples are off by 1e-3 rad/s: a microradian per second grows to 20 times the noise."""
    machine, data = prepare(carriage(coulomb=FRICTION, constant_torque=PULL), recordings)
    assert all(run.start.moving for run in data.runs)
    assert score(machine, data).free_run < 1.1


@pytest.mark.slow(minutes=1)
def test_friction_of_a_millionth_is_found_beside_a_pull(recordings):
    found = diagnose(carriage(), recordings, jobs=1)
    assert (found.verdict, set(found.effects)) == ("effects", {"coulomb", "constant_torque"})
    assert found.arm.value("effects.coulomb.torque") == pytest.approx(FRICTION, rel=0.03)
    assert found.arm.value("effects.constant_torque.torque") == pytest.approx(PULL, rel=0.03)


@pytest.mark.parametrize("level", [0.03, 1e-3, 1e-5])
def test_what_noise_leaves_under_an_observer_is_measured(recordings, level):
    """Of a machine without faults, an observer that trusts its readings too much leaves more than their noise."""
    machine, data = prepare(carriage(coulomb=FRICTION, constant_torque=PULL), recordings)
    objective = objective_at(machine, data, free_parameters(machine, machine, data), level * 0.5)
    plant = next(iter(data.plants(machine).values()))
    expected = innovation_noise(plant, data, observer_gains(machine, plant, data, level * 0.5))
    assert objective.rms_errors_of(machine)[:, 0] == pytest.approx(float(expected[0]), rel=0.06)
    assert objective.weighted_by(machine).excess_factor == pytest.approx(1.0, abs=0.06)
    if level == 0.03:
        assert expected[0] > 2.0 * data.noise[0]


def test_an_observer_without_gains_passes_no_noise_on(recordings):
    machine, data = prepare(carriage(), recordings)
    plant = next(iter(data.plants(machine).values()))
    none = np.zeros((plant.modes, plant.states, 1))
    assert innovation_noise(plant, data, none) == pytest.approx(data.noise)


def test_a_value_without_room_beyond_is_put_at_its_bound():
    """A torque below zero is zero: differences to either side of it would show no slope."""
    torque = FitParameter("effects.coulomb.torque", 1e-6, 1e-3, 30.0, 0.0, 1e4)
    length = FitParameter("beam.length", 0.4, 0.0, 0.05, 0.0, 1e3)
    x = FitParameters((torque, length)).within(np.array([-0.5, -0.5]))
    assert x == pytest.approx([-1e-3, -0.5])
    assert torque.value(float(x[0])) == 0.0


def test_a_speed_at_the_start_leaves_the_first_angle_as_that_at_rest():
    time = np.arange(200) / 250.0
    measured = (0.3 + 0.5 * time**2 - 0.4 * time**3)[:, None]
    start = find_start(time, np.ones(200), measured, ["arm_angle"], np.array([1e-7]), SETTINGS.initial_states)
    assert start.moving
    assert start.rest == pytest.approx(0.3, abs=1e-6)


def test_a_size_at_its_bound_explains_nothing_and_a_damping_does():
    machine = carriage().with_effect("end_stop", stiffness=5.0, upper=0.1, lower=-0.1, damping_time=0.0)
    nominal, data = prepare(carriage(), [pushed(machine, 0.0, 0.4)])
    calibrator = Calibrator(nominal, data)
    for values, is_at_bound in (({"damping_time": 0.0}, False), ({"stiffness": 0.0}, True)):
        arm = nominal.with_effect("end_stop", **({"stiffness": 5.0, "upper": 0.1, "lower": -0.1, "damping_time": 2e-3} | values))
        assert judge(("end_stop",), calibrator.uncalibrated(arm), data).at_bound is is_at_bound
