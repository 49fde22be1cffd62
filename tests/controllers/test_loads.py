"""Loads that the believed arm has are met by every controller: at rest in closed form, and in the loop."""

from __future__ import annotations

import numpy as np
import pytest
from controllers.loop import INTERVAL, slew

from flexarm_env import Arm
from flexarm_env.controllers import CONTROLLERS, make_controller
from flexarm_env.controllers.loads import KnownLoads

LOADS = {
    "constant_torque": {"torque": 0.15},
    "dead_zone": {"width": 0.4},
    "cable_stiffness": {"stiffness": 0.15, "rest_angle": 0.3},
}
PER_AMP = 1.5 * 0.33  # torque on the hub, from Table 2.1


def test_spring_and_torque_are_held_at_the_target(thesis):
    loads = KnownLoads(
        thesis.with_effect("cable_stiffness", stiffness=0.2, rest_angle=0.3).with_effect("constant_torque", torque=-0.1)
    )
    target = np.array([-1.0, 0.0, 1.7])
    np.testing.assert_allclose(PER_AMP * loads.compensated(np.zeros(3), target), 0.2 * (target - 0.3) + 0.1, rtol=1e-12)


def test_a_dead_zone_lets_through_what_was_wanted(thesis):
    loads = KnownLoads(thesis.with_effect("dead_zone", width=0.4))
    wanted = np.array([-3.0, -0.1, 0.1, 0.7])
    np.testing.assert_allclose(loads.behind_dead_zone(loads.compensated(wanted, np.zeros(4))), wanted, rtol=1e-12)
    small = loads.compensated(np.linspace(-0.1, 0.1, 41), np.zeros(41))
    assert np.abs(np.diff(small)).max() < 0.026  # five times as steep, and nowhere thrown across


def test_an_arm_without_loads_changes_no_bit(thesis):
    command = np.random.default_rng(0).standard_normal(100)
    loads = KnownLoads(thesis)
    assert np.array_equal(loads.compensated(command, command), command)
    assert np.array_equal(loads.behind_dead_zone(command), command)


@pytest.mark.parametrize("name", ["pd", "lqg", "lqg_scheduled", "vibration_filtered"])
def test_an_arm_with_a_known_load_ends_where_the_arm_without_it_does(thesis, name):
    def end(arm, believed):
        return slew(arm, make_controller(name, believed, INTERVAL), 5.0).error[-100:].mean()

    free = end(thesis, thesis)
    torque, zone, cable = (thesis.with_effect(effect, **values) for effect, values in LOADS.items())
    assert end(torque, torque) == pytest.approx(free, abs=0.02)  # a constant is met at once: only roundings differ
    assert end(zone, zone) == pytest.approx(free, abs=0.2)
    # the spring's share of the torque is right at the target only, so friction holds the hub somewhere else
    assert abs(end(cable, cable)) < min(abs(free) + 0.1, 0.7 * abs(end(cable, thesis)))
    assert abs(end(zone, thesis)) > abs(free) + 0.2


@pytest.mark.parametrize("name", CONTROLLERS)
def test_every_controller_starts_a_slew_with_the_load_met(thesis, name):
    loaded = thesis.with_effect("constant_torque", torque=0.05)
    first = []
    for arm in (thesis, loaded):
        controller = make_controller(name, arm, INTERVAL)
        controller.reset()
        # at its target, so that no law wants anything
        first.append(float(controller.act(np.array([0.0, 0.0, 0.0, 0.0, 0.0]))))
    assert first[1] - first[0] == pytest.approx(-0.05 / PER_AMP, rel=1e-9)


def test_the_weight_of_beam_and_payload_is_held_at_the_target(thesis):
    leaning = thesis.with_effect("base_tilt", torque=0.2, uphill=0.4)
    target = np.array([-1.0, 0.4, 1.7])
    held = 0.2 * np.sin(target - 0.4)
    np.testing.assert_allclose(PER_AMP * KnownLoads(leaning).steady(target), -held, atol=1e-12)
    # a payload at the tip weighs as much as it does, over half the beam's mass
    payload = leaning.with_effect("payload", mass=0.1)
    half = 0.5 * thesis.value("beam.mass_per_length") * thesis.value("beam.length")
    np.testing.assert_allclose(PER_AMP * KnownLoads(payload).steady(target), -held * (1.0 + 0.1 / half), atol=1e-12)


def test_weights_of_a_link_and_of_a_tilted_base_add_up():
    drive = {"input": "torque", "gear_ratio": 1.0, "motor_inertia": 0.0, "limit": 10.0}
    link = {"mass": 0.5, "centre": 0.4, "length": 1.0, "inertia": 0.1, "vertical": True, "hangs_at": 0.0}
    arm = Arm.from_table({"drive": drive, "link": link, "sensors": {"arm_angle": {"noise": 1e-4}}}, "pendulum")
    both = arm.with_effect("base_tilt", torque=0.3, uphill=0.0)
    target = np.array([0.3, 1.2])
    hangs = 0.5 * 0.4 * 9.80665 * np.sin(target)
    np.testing.assert_allclose(KnownLoads(arm).steady(target), hangs, rtol=1e-12)
    np.testing.assert_allclose(KnownLoads(both).steady(target), hangs - 0.3 * np.sin(target), rtol=1e-12)


@pytest.mark.parametrize("name", ["pd", "lqg", "lqg_scheduled", "mpc"])
def test_a_leaning_arm_ends_where_the_level_one_does(thesis, name):
    """Where its weight is not known, that pulls it ten degrees away, and bends the beam, which looks like a payload."""
    leaning = thesis.with_effect("base_tilt", torque=0.5, uphill=3.3)

    def end(arm, believed):
        return abs(slew(arm, make_controller(name, believed, INTERVAL), 5.0).error[-100:].mean())

    assert end(leaning, leaning) < end(thesis, thesis) + 2.0
    assert end(leaning, thesis) > end(thesis, thesis) + 10.0
