"""Friction beyond a budget that depends on motion: it yields before it slides, follows the gears' load, and fades as a whole."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from flexarm_env.arm import Arm

SLIDING, COMPLIANCE = 0.2, 0.05


@pytest.fixture(scope="module")
def hub_only() -> Arm:
    """An arm of six elements and two bodies, whose dry friction is the hub's, and yields."""
    arm = replace(Arm.load("thesis-fem"), effects={}).with_effect("coulomb", torque=SLIDING)
    shares = {"drive.motor_coulomb_share": 0.0, "drive.motor_stiction_share": 0.0}
    return arm.with_values(shares).with_effect("presliding", compliance=COMPLIANCE)


@pytest.mark.parametrize(
    ("effects", "more", "near"),
    [
        ({}, lambda v: 0.0, 1e-8),
        # where the level that friction relaxes to depends on speed, it is that at the end of a sample: an error of first order
        ({"stribeck": {"extra": 0.15, "falloff_speed": 0.5}}, lambda v: 0.15 * math.exp(-((v / 0.5) ** 2)), 3e-4),
        ({"viscous": {"coefficient": 0.1}, "asymmetric_viscous": {"coefficient": 0.05}}, lambda v: 0.05 * v, 3e-4),
    ],
)
def test_presliding_agrees_with_an_ordinary_solver_of_dahl_s_equation(hub_only, effects, more, near):
    arm = hub_only
    for name, values in effects.items():
        arm = arm.with_effect(name, **values)
    plant, structure = arm.plant(0.002), arm.structure()
    plant.place()
    model, count = plant.model, 50
    size = len(model.names)
    windup = np.zeros(size)
    windup[0], windup[1] = -1.0, 1.0
    gears = structure.gear_stiffness * np.outer(windup, windup)
    stiffness, damping = model.stiffness + gears, model.damping + structure.gear_damping_time * gears

    def rate(_: float, x: np.ndarray, command: float) -> np.ndarray:
        q, v, friction = x[:size], x[size:-1], x[-1]
        force = model.input[:, 0] * command - damping @ v - stiffness @ q
        force[0] -= friction
        yields = (v[0] - abs(v[0]) * friction / (SLIDING + more(v[0]))) / COMPLIANCE
        return np.concatenate([v, np.linalg.solve(model.mass, force), [yields]])

    commands, times = (2.0, -2.0, 0.0), 0.002 * np.arange(count + 1)
    x, states = np.zeros(2 * size + 1), []
    for command in commands:
        exact = solve_ivp(rate, (0.0, times[-1]), x, "LSODA", times, args=(command,), rtol=1e-9, atol=1e-11)
        x = exact.y[:, -1]
        states.append(exact.y[:, :-1])
    hub, speed = np.hstack(states)[[0, size + 1]]
    readings = plant.replay(np.repeat(commands, count))
    assert (np.diff(np.sign(np.diff(hub))) != 0).sum() > 5, "the hub turns round, or friction's memory is not tried"
    assert np.abs(readings[:, 0] - hub).max() < near
    assert np.abs(readings[:, 1] - 1.5 * speed).max() < 100.0 * near


def test_a_slow_push_yields_as_dahl_s_equation_says(hub_only):
    slow = hub_only.with_effect("viscous", coefficient=5.0)
    plant = slow.plant(0.005)
    plant.place()
    per_amp = 1.5 * slow.constants["drive"]["torque_constant"]
    for share in (0.3, 0.6, 0.9):
        here = plant.physical()[0]
        reached = share * SLIDING / per_amp
        plant.replay(np.full(4000, reached))
        assert plant.physical()[0] > here
        assert plant.physical()[0] == pytest.approx(-COMPLIANCE * SLIDING * math.log(1.0 - share), rel=1e-3)
    plant.replay(np.zeros(4000))  # let go, it comes back along another branch: T = −T_c + 1.9 T_c exp(−travel / (c T_c)) is 0
    back = -COMPLIANCE * SLIDING * (math.log(0.1) + math.log(1.9))
    assert plant.physical()[0] == pytest.approx(back, rel=1e-3)


def test_rigid_gears_carry_the_drive_s_torque():
    arm = replace(Arm.load("thesis"), effects={}).with_effect("coulomb", torque=0.1)
    load = arm.with_effect("load_friction", coefficient=0.25)
    command = 2.0
    torque = arm.constants["drive"]["gear_ratio"] * arm.constants["drive"]["torque_constant"] * command
    more = arm.with_effect("coulomb", torque=0.1 + 0.25 * torque)
    ends = []
    for one in (load, more):
        plant = one.plant(0.005)
        plant.place()
        ends.append(plant.replay(np.full(40, command))[-1])
    assert np.allclose(ends[0], ends[1], rtol=1e-9)


def end_speed(effects: dict[str, dict[str, float]], command: float) -> float:
    """Speed [rad/s] that a rigid link reaches under a constant command [A]; 0.495 Nm/A act on its axis."""
    table = {
        "drive": {"input": "current", "torque_constant": 0.495, "gear_ratio": 1.0, "motor_inertia": 0.0, "limit": 100.0},
        "hub": {"inertia": 0.01},
    }
    arm = Arm.from_table(table | {"effects": effects, "sensors": {"arm_angle": {"noise": 1e-4}}}, "link")
    plant = arm.plant(0.005)
    plant.place()
    plant.replay(np.full(2000, command))
    size = plant.physical().size // 2
    return float(plant.physical()[size])


@pytest.mark.parametrize(("command", "speed"), [(4.0, (1.98 - 0.3) / 0.12), (-4.0, -(1.98 - 0.3) / 0.08)])
def test_a_lubricant_s_friction_by_direction_is_whole_where_it_exceeds_the_dry_one(command, speed):
    effects = {"viscous": {"coefficient": 0.1}, "coulomb": {"torque": 0.3}, "asymmetric_viscous": {"coefficient": 0.02}}
    assert end_speed(effects, command) == pytest.approx(speed, rel=1e-9)


def test_warming_takes_dry_friction_and_leaves_that_of_the_lubricant():
    effects = {
        "viscous": {"coefficient": 0.1},
        "coulomb": {"torque": 0.3},
        "asymmetric_viscous": {"coefficient": 0.02},
        "friction_warmup": {"share": 0.5, "time_constant": 0.1},
    }
    assert end_speed(effects, -4.0) == pytest.approx(-(1.98 - 0.15) / 0.08, rel=1e-6)


def test_a_lubricant_takes_away_all_viscous_friction_at_most_and_does_not_drive():
    effects = {"viscous": {"coefficient": 0.1}, "coulomb": {"torque": 0.3}, "asymmetric_viscous": {"coefficient": 0.5}}
    free = end_speed({"coulomb": {"torque": 0.3}}, -0.8)
    assert end_speed(effects, -0.8) == pytest.approx(free, rel=1e-6)
    assert free < -90.0
