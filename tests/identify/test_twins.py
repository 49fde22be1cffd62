"""Effects that move a machine alike in its recordings: the one whose law depends on less is named first."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.effects import catalogue


@pytest.fixture(scope="module")
def axis() -> Arm:
    friction = {"viscous": {"coefficient": 0.02}, "coulomb": {"torque": 0.02}}
    drive = {"input": "torque", "limit": 4.0, "gear_ratio": 1.0}
    sensors = {"arm_angle": {"resolution": 1e-4}, "motor_speed": {"noise": 0.02}}
    return Arm.from_table({"drive": drive, "hub": {"inertia": 0.02}, "effects": friction, "sensors": sensors}, "axis")


def recorded(arm: Arm) -> Recording:
    """Turn back and forth without a rest."""
    time = np.arange(0.0, 6.0, 0.004)
    command = 0.3 * np.sign(np.sin(2.0 * np.pi * 0.8 * time + 0.3)) + 0.05 * np.cos(2.0 * np.pi * 2.3 * time)
    asked = Recording.from_arrays("run", time, "torque", command, dict.fromkeys(arm.signals, np.zeros(len(time))))
    return simulate(arm, asked, seed=4)


@pytest.mark.parametrize("hidden", ["constant_torque", "asymmetric_coulomb"])
def test_a_constant_torque_is_named_before_friction_that_differs_by_direction(axis, hidden):
    found = diagnose(axis, [recorded(axis.with_effect(hidden, torque=-0.005))], jobs=1)
    assert found.effects == ["constant_torque"]
    assert found.equivalent[0][:2] == ["constant_torque", "asymmetric_coulomb"]


def test_a_law_says_on_how_much_it_depends():
    counts = {name: catalogue()[name].quantities() for name in ("constant_torque", "viscous", "asymmetric_coulomb", "cogging")}
    assert counts == {"constant_torque": 0, "viscous": 0, "asymmetric_coulomb": 2, "cogging": 1}
