"""Arm files of machines of one joint: what is missing, or excludes what else is there, is refused in one line."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from one_joint import ENCODERS, LINK, elastic_joint, pendulum, servo

from flexarm_env import Arm, InputError

SERVO = {"input": "position", **dict(servo().constants["drive"])}
TORQUE = {"input": "torque"}


def table(**changes: Any) -> dict[str, Any]:
    """Build the table of a pendulum with other sections; None takes one out."""
    whole = {"drive": TORQUE, "link": LINK, "sensors": ENCODERS} | changes
    return {section: values for section, values in whole.items() if values is not None}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"drive": TORQUE | {"torque_constant": 0.1}}, r"drive\.torque_constant: a torque drive has none"),
        ({"drive": TORQUE | {"error_gain": 0.1}}, r'drive\.error_gain is of a servo, and drive\.input is "torque"'),
        ({"drive": TORQUE | {"supply_voltage": 12}}, r"drive\.supply_voltage: a torque drive has none"),
        ({"drive": TORQUE | {"largest_duty": 0.5}}, r'drive\.largest_duty is of a servo, and drive\.input is "torque"'),
        ({"drive": TORQUE | {"enabled": True}}, r"drive\.enabled = True is no number; write for example 1$"),
        ({"link": LINK | {"mass": True}}, r'link\.mass = True is no number; write for example 0\.1 or "0\.1 kg"'),
        ({"sensors": {"arm_angle": 5}}, r"sensors\.arm_angle is not a table; write \[sensors\.arm_angle\]"),
        ({"drive": SERVO, "sensors": {"motor_current": {}}}, r"motor_current needs a drive other than a servo"),
        ({"drive": TORQUE, "sensors": {"motor_current": {}}}, r"motor_current needs a motor with constants of its own"),
        ({"conditions": {"arm mass": "link.mass"}}, r"condition 'arm mass': write its name in letters"),
        ({"conditions": {"paylod": "link.mass"}}, r"unknown condition 'paylod'; did you mean 'payload'"),
        ({"drive": SERVO | {"proportional": 0}}, r"drive\.proportional is missing or 0: the servo"),
        ({"drive": SERVO | {"supply_voltage": 0}}, r"drive\.supply_voltage is missing or 0"),
        ({"drive": SERVO | {"resistance": 0}}, r"drive\.resistance is missing .* position drive needs it"),
        ({"drive": TORQUE | {"enabled": 0.5}}, r"drive\.enabled = 0\.5; write 1 .* 0"),
        ({"link": LINK | {"tilt": 0.1}}, r"link\.vertical and link\.tilt are both there"),
        ({"link": LINK | {"vertical": "yes"}}, r"link\.vertical = 'yes'; write true or false"),
        ({"drive": SERVO | {"largest_duty": "90 %"}}, r"drive\.largest_duty: unit '%' on a bare number; write 0\.9$"),
        ({"drive": TORQUE | {"efficiency": "85 percent"}}, r"drive\.efficiency: unit 'percent' on a bare number; write 0\.85$"),
        ({"effects": {"load_friction": {"coefficient": "5%"}}}, r"coefficient: unit '%' on a bare number; write 0\.05$"),
        ({"link": LINK | {"center": 0.1}}, r"unknown key 'link\.center'; did you mean 'centre'"),
        ({"link": None}, r"table \[hub\] is missing"),
        ({"link": None, "hub": {"inertia": 0}}, r"hub\.inertia is 0 and there is neither beam nor link"),
        ({"joint": {"stiffness": 1.0}}, r"\[joint\] has nothing in front of it"),
        ({"joint": {"stiffness": 1.0}, "link": None, "hub": {"inertia": 1.0}}, r"\[joint\] has nothing behind it"),
        (
            {"joint": {"stiffness": 1.0}, "drive": TORQUE | {"gear_stiffness": 5.0}, "hub": {"inertia": 1.0}},
            r"drive\.gear_stiffness and \[joint\] are both there",
        ),
        (
            {"beam": {"elements": 1, "length": 1, "mass_per_length": 1, "bending_stiffness": 1}},
            r"\[beam\] and \[link\] are both there",
        ),
    ],
)
def test_what_does_not_fit_is_refused_in_one_line(changes, words):
    with pytest.raises(InputError, match=words) as refusal:
        Arm.from_table(table(**changes), "machine")
    assert "\n" not in str(refusal.value)


def test_a_vertical_plane_means_a_level_axis():
    assert pendulum().value("link.tilt") == math.pi / 2
    assert pendulum(vertical=False).value("link.tilt") == 0.0


def test_what_is_no_property_of_the_machine_is_not_fitted():
    level = pendulum(vertical=False)
    assert level.parameter("link.mass").spread == 0.0, "no gravity acts on it"
    assert pendulum().parameter("link.mass").spread > 0.0
    assert level.parameter("drive.torque_constant").spread == 0.0, "a torque drive has none"
    assert elastic_joint().parameter("drive.motor_coulomb_share").spread == 0.0, "all friction is in front of the spring"
    assert elastic_joint().value("drive.motor_coulomb_share") == 1.0


def test_an_arm_says_what_it_has():
    assert [arm.has("tip") for arm in (pendulum(), pendulum(length=0.0), Arm.load("thesis"))] == [True, False, True]
    assert [arm.has("soft_gears") for arm in (elastic_joint(), pendulum(), Arm.load("thesis-fem"))] == [True, False, True]
    assert [arm.has("supply") for arm in (servo(), elastic_joint())] == [True, False]
    known = replace(servo(), fixed=("drive.supply_voltage",))
    assert [servo().can_have("supply_sag"), known.can_have("supply_sag")] == [True, False], "a voltage measured at the drive"
    measured = elastic_joint().constants | {"sensors": {"arm_angle": {}, "motor_current": {}}}
    measured["drive"] = {"input": "voltage"} | measured["drive"] | {"supply_voltage": 12.0}
    assert not Arm.from_table(measured, "measured").can_have("supply_sag"), "its current is a signal, which sag does not give"
    assert [arm.has("motor") for arm in (servo(), pendulum())] == [True, False]
    assert [arm.can_have("current_lag") for arm in (servo(), pendulum())] == [False, True]
    assert [arm.has("windup") for arm in (servo(), elastic_joint(), Arm.load("emps"))] == [True, True, False]


@pytest.mark.parametrize(
    ("inertia", "hub", "words"),
    [
        (0.005, 0.0, r"link\.inertia = 0\.005 kg\*m\*\*2 is below mass times centre squared, 0\.02: .* axis; write 0\.025 if"),
        (0.0, 1.0, r"link\.inertia = 0 kg\*m\*\*2 is below mass times centre squared, 0\.02"),
    ],
)
def test_a_link_with_less_inertia_than_its_mass_as_a_point_is_refused(inertia, hub, words):
    with pytest.raises(InputError, match=words) as refusal:
        Arm.from_table(table(link=LINK | {"inertia": inertia}, hub={"inertia": hub}), "machine")
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(("inertia", "hub"), [(0.5 * 0.2**2, 0.0), (0.02 - 1e-12, 0.0), (0.0, 100.0)])
def test_a_point_mass_and_a_difference_that_no_motion_shows_are_taken(inertia, hub):
    assert (
        Arm.from_table(table(link=LINK | {"inertia": inertia}, hub={"inertia": hub}), "machine").value("link.inertia") == inertia
    )


def test_a_fitted_link_is_read_whatever_share_of_its_moment_is_mass(tmp_path):
    fitted = {"link.mass": {"value": 5.0, "low": 4.9, "high": 5.1, "unit": "kg"}}
    heavier = replace(pendulum().with_values({"link.mass": 5.0}), fitted=fitted)
    heavier.save(tmp_path / "fitted.toml")
    assert Arm.load(tmp_path / "fitted.toml").value("link.mass") == 5.0
