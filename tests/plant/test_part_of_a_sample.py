"""A command that is late by part of a sample acts as it does on a grid on which it is late by whole samples."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate

RATE, PARTS = 100.0, 5
COUNT = 150
#: Rigid axis, whose gears carry the load of the command alone; beam; link on a spring.
DRIVE = {"input": "current", "torque_constant": 0.1, "gear_ratio": 10.0, "motor_inertia": 1e-3, "limit": 10.0}
ARMS = {
    "axis": {"drive": DRIVE, "hub": {"inertia": 0.4}},
    "beam": {
        "drive": DRIVE,
        "hub": {"inertia": 0.1},
        "beam": {"elements": 1, "length": 1.0, "mass_per_length": 0.4, "bending_stiffness": 8.0},
    },
    "joint": {"drive": DRIVE | {"gear_stiffness": 300.0}, "hub": {"inertia": 0.4}},
}
FRICTION = {"viscous": {"coefficient": 0.1}, "coulomb": {"torque": 0.3}}
#: Relative differences: a ramp is replaced by its mean over parts of a sample, a stop's contact begins within a fitted step.
TOLERANCE, TOLERANCES = 1e-7, {"rate_limit": 2e-3, "end_stop": 1e-5}


def arm_of(name: str) -> Arm:
    return Arm.from_table(ARMS[name] | {"effects": FRICTION, "sensors": {"arm_angle": {}, "motor_speed": {}}}, name)


EFFECTS = [
    (name, effect)
    for name in ARMS
    for effect in arm_of(name).known
    if effect not in {*FRICTION, "input_delay", "time_offset"} and arm_of(name).can_have(effect)
]


def played(arm: Arm, rate: float, command: np.ndarray) -> np.ndarray:
    """Angles [rad] of an arm under a held command."""
    time = np.arange(len(command)) / rate
    asked = Recording.from_arrays("run", time, "current", command, dict.fromkeys(arm.signals, np.zeros(len(time))))
    return simulate(arm, asked, noise=False).signals["arm_angle"]


@pytest.mark.parametrize(("name", "effect"), EFFECTS)
def test_a_delay_of_part_of_a_sample(name, effect):
    arm = arm_of(name).with_effect(effect)
    time = np.arange(COUNT) / RATE
    command = np.round(4.0 * np.sin(2.0 * np.pi * 1.3 * time) + 1.5 * np.sin(2.0 * np.pi * 3.7 * time), 3)
    late = arm.with_effect("input_delay", delay=2.0 / PARTS / RATE)
    fine = np.r_[np.zeros(2), np.repeat(command, PARTS)[:-2]]
    coarse, finer = played(late, RATE, command), played(arm, RATE * PARTS, fine)[::PARTS]
    size = np.ptp(coarse)
    assert size > 0.01
    assert np.max(np.abs(coarse - finer)) < TOLERANCES.get(effect, TOLERANCE) * size
