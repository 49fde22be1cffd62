"""Loads that the believed arm has are met by every controller: at rest in closed form, and in the loop."""

from __future__ import annotations

import numpy as np
import pytest
from controllers.loop import INTERVAL, slew

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
