"""The linearised arm against the plant and against the frequencies in the thesis's notes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from controllers.loop import INTERVAL, frictionless, loaded

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.linear import linearise


@pytest.mark.parametrize("name", ["thesis", "thesis-fem", "cu-flexible", "cu-rigid", "emps"])
def test_a_moving_arm_goes_where_the_plant_goes(name):
    arm = frictionless(Arm.load(name))
    plant, linear = arm.plant(INTERVAL), linearise(arm, "moving", INTERVAL)
    commands = np.random.default_rng(0).uniform(-1.0, 1.0, 60)
    state, expected = np.zeros(len(linear.states)), []
    for command in commands:
        expected.append(linear.output @ state + linear.offset)
        state = linear.transition @ state + linear.response[:, 0] * command
    plant.place()
    readings = plant.replay(commands)
    scale = np.abs(readings).max(axis=0)
    assert np.abs(readings - expected).max(axis=0) == pytest.approx(0.0, abs=1e-7 * scale.max())


@pytest.mark.parametrize("mode", ["moving", "stuck"])
@pytest.mark.parametrize("lagged", [False, True])
def test_transition_is_the_plants(arm, mode, lagged):
    if lagged:
        sensors = {name: {**table, "filter": 0.01} for name, table in arm.sensors.items()}
        arm = replace(arm, sensors=sensors).with_effect("current_lag", time=0.003)
    plant, linear = arm.plant(INTERVAL), linearise(arm, mode, INTERVAL)
    transition, push = plant.transition({"moving": 0, "stuck": plant.modes - 1}[mode], INTERVAL)
    held = range(plant.bodies) if mode == "stuck" else ()
    for body in held:
        transition[body, body] = 1.0
    # a held angle goes into the filters as well, which the plant's matrix for free motion leaves out
    there = np.ones(len(transition), dtype=bool) if not lagged or mode == "moving" else np.arange(len(transition)) >= plant.bodies
    np.testing.assert_allclose(linear.transition[:, there], transition[:, there], atol=1e-10 * np.abs(transition).max())
    np.testing.assert_allclose(linear.response[:, 1], push, atol=1e-12)


def test_a_held_angle_reaches_its_filtered_sensor(thesis):
    sensors = {name: {**table, "filter": 0.01} for name, table in thesis.sensors.items()}
    linear = linearise(replace(thesis, sensors=sensors), "stuck", INTERVAL)
    state = np.zeros(len(linear.states))
    state[linear.states.index("hub")] = 0.7
    for _ in range(400):
        state = linear.transition @ state
    assert (linear.output @ state)[0] == pytest.approx(0.7, rel=1e-9)


# Table in the thesis's notes: without friction, one element
@pytest.mark.parametrize(
    ("mode", "mass", "frequencies"),
    [("moving", 0.0, (8.964, 29.62)), ("stuck", 0.0, (2.429, 23.94)), ("moving", 0.3, (6.911,)), ("stuck", 0.3, (1.225,))],
)
def test_frequencies_of_the_notes(thesis, mode, mass, frequencies):
    found, damping = linearise(loaded(frictionless(thesis), mass), mode, INTERVAL).vibrations()
    np.testing.assert_allclose(found[: len(frequencies)], frequencies, rtol=5e-4)
    np.testing.assert_allclose(damping, 0.0, atol=1e-9)


def test_discrete_matrices_follow_from_the_continuous_ones(arm):
    for mode in ("moving", "stuck"):
        linear = linearise(arm, mode, INTERVAL)
        size = len(linear.states)
        step = scipy.linalg.expm(np.block([[linear.dynamics, linear.forcing], [np.zeros((3, size + 3))]]) * INTERVAL)
        if mode == "stuck":  # a held body has no speed, whatever it had before
            rates = [place for place, state in enumerate(linear.states) if state in ("hub_rate", "motor_rate")]
            step[rates, rates] = 0.0
        np.testing.assert_allclose(linear.transition, step[:size, :size], atol=1e-8 * np.abs(step).max())
        np.testing.assert_allclose(linear.response, step[:size, size:], atol=1e-8)
    assert linear.inputs == ("command", "hub_torque", "weight")
    assert linear.states[0] == "hub"


@pytest.mark.parametrize(("mode", "interval", "word"), [("stuk", 0.005, "did you mean 'stuck'"), ("moving", 0.0, "interval")])
def test_bad_input_gets_one_line(thesis, mode, interval, word):
    with pytest.raises(InputError, match=word) as error:
        linearise(thesis, mode, interval)
    assert "\n" not in str(error.value)


def test_the_weight_of_a_rigid_link_is_a_torque_on_the_hub_to_which_the_payload_adds():
    drive = {"input": "torque", "gear_ratio": 1.0, "motor_inertia": 0.0, "limit": 10.0}
    link = {"mass": 0.5, "centre": 0.4, "length": 1.0, "inertia": 0.1, "vertical": True, "hangs_at": 0.0}
    arm = Arm.from_table({"drive": drive, "link": link, "sensors": {"arm_angle": {"noise": 1e-4}}}, "pendulum")
    for heavy, share in ((arm, 1.0), (arm.with_effect("payload", mass=0.3), 1.0 + 0.3 / (0.5 * 0.4))):
        _, torque, weight = linearise(heavy, "moving", INTERVAL).forcing.T
        np.testing.assert_allclose(weight, share * torque, rtol=1e-12)
