"""The benchmark of elastic joints: its rig rings and lags as it says, and its table counts what it says."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.elastic_joint.cases import GIVEN_DELAY, RATE, Key, draw_machine, model_of, record
from benchmarks.elastic_joint.score import figures, misses
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score


@pytest.fixture(scope="module")
def machine():
    return draw_machine(np.random.default_rng(5))


def test_a_case_is_its_seed_and_index():
    first, again, other = (Key(7, index).pose() for index in (2, 2, 3))
    assert first[0] == again[0] != other[0]
    assert np.array_equal(first[2][0].signals["arm_angle"], again[2][0].signals["arm_angle"])
    assert first[1].effects["input_delay"]["delay"] == GIVEN_DELAY


def test_the_model_with_the_truth_meets_the_rig(machine):
    """Nearly to the noise: a loop of 10 kHz is late by 0.05 ms on average, and the model's is not."""
    draw = np.random.default_rng(5)
    time = np.arange(0.0, 3.0, 1.0 / RATE)
    goal = machine.angle * np.sin(2.0 * np.pi * 1.7 * time) * np.minimum(time, 1.0)
    arm = model_of(machine, draw).with_effect("gear_compliance", stiffness=machine.stiffness, damping_time=5e-4)
    true = {
        "hub.inertia": machine.link,
        "effects.coulomb.torque": machine.coulomb,
        "effects.viscous.coefficient": machine.viscous,
    }
    arm = arm.with_values(true | {"effects.input_delay.delay": machine.delay})
    recording = record(machine, "run", goal, 1)
    left, of_rigid = (score(*prepare(one, [recording])).free_run for one in (arm, arm.without_effect("gear_compliance")))
    assert left < 3.0
    assert of_rigid > 4.0 * left


def answer(named: str, **constants: float) -> dict:
    truth = {"resonance": 15.0, "delay": 0.004, "coulomb": 1.0}
    found = {"effects": [named], "verdict": "effects", "constants": {key: {"value": value} for key, value in constants.items()}}
    found["error"] = {"nominal": 50.0, "final": 1.0}
    return {"case": {"name": "0000", "machine": truth}, "found": found, "cpu_seconds": 10.0, "version": "1", "commit": "c"}


def test_the_table_counts_what_is_found():
    stiffness = (2.0 * math.pi * 15.0) ** 2
    right = {"hub_inertia": 1.0, "input_delay_delay": 0.0045, "coulomb_torque": 1.05}
    answers = [
        answer("gear_compliance", gear_compliance_stiffness=stiffness * 1.03, **right),
        answer("gear_compliance", gear_compliance_stiffness=stiffness * 1.05, **right),
        answer("current_lag", hub_inertia=1.0, input_delay_delay=0.0055, coulomb_torque=1.2),
    ]
    assert [figure.value for figure in figures(answers)[:4]] == pytest.approx([2 / 3, 1 / 3, 2 / 3, 2 / 3])
    assert len(misses(answers)) == 2 + 2
