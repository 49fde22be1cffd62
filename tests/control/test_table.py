"""The `[controller]` table: units, refusals, and what an arm file keeps of it."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from flexarm_env.arm import Arm
from flexarm_env.arm_file import shipped_arms
from flexarm_env.control.law import ControlLaw, Feedback
from flexarm_env.control.table import law_from_table
from flexarm_env.errors import InputError

P = {"proportional": 1.0}


def test_gains_have_units():
    table = {
        "limit": "500 mV",
        "rate": "0.2 kHz",
        "delay": "5 ms",
        "arm_angle": {
            "proportional": "0.1 V/deg",
            "integral": "3 V/rad/s",
            "derivative": "2 mV*s/mrad",
            "derivative_span": "2 ms",
        },
        "motor_speed": {"proportional": "1 V*s/rad", "filter": 0.007},
    }
    angle = Feedback("arm_angle", (18 / 3.141592653589793,), (3.0,), (2.0,), derivative_span=0.002)
    speed = Feedback("motor_speed", (1.0,), filter=0.007)
    found = law_from_table(table, "voltage")
    assert (found.limit, found.rate, found.delay) == (0.5, 200.0, 0.005)
    assert found.feedback[0].proportional == pytest.approx(angle.proportional)
    assert (replace(found.feedback[0], proportional=angle.proportional), found.feedback[1]) == (angle, speed)


def test_factors_of_a_gain_are_multiplied():
    found = law_from_table({"arm_angle": {"proportional": ["kp", "243 V*s/rad", -1]}}, "voltage")
    assert found.feedback[0].proportional == ("kp", 243.0, -1.0)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ([], "is not a table"),
        ({}, "no gain"),
        ({"arm_angle": {}}, "no gain"),
        ({"limit": 5.0, "arm_angel": P}, "arm_angel.*arm_angle"),
        ({"arm_angle": {"proportion": 1.0}}, "proportion.*proportional"),
        ({"arm_angle": 3.0}, r"\[controller.arm_angle\]"),
        ({"arm_angle": {"proportional": "6 V/rad"}}, "controller.arm_angle.proportional.*A/rad"),
        ({"arm_angle": {"derivative": "6 A/rad"}}, "controller.arm_angle.derivative"),
        ({"motor_speed": {"proportional": "6 A/rad"}}, "controller.motor_speed.proportional"),
        ({"arm_angle": {"proportional": "K 1"}}, "name of a condition"),
        ({"arm_angle": {"proportional": True}}, "name of a condition"),
        ({"arm_angle": {"proportional": []}}, "empty list"),
        ({"arm_angle": {"proportional": ["kp", ["kv"]]}}, "name of a condition"),
        ({"arm_angle": {"proportional": float("nan")}}, "finite"),
        ({"arm_angle": P, "limit": "5 V"}, "controller.limit"),
        ({"arm_angle": P, "limit": -5.0}, "controller.limit = -5 A is out of bounds"),
        ({"arm_angle": P, "delay": 1e300}, r"controller.delay = 1e\+300 s is out of bounds: allowed are 0 to 10 s"),
        ({"arm_angle": P, "rate": 1e300}, "controller.rate = .* allowed are 0 to 1e.06 Hz"),
        ({"arm_angle": P | {"derivative_span": "1 Ps"}}, "controller.arm_angle.derivative_span = 1e.15 s is out of bounds"),
        ({"arm_angle": P, "rate": "2 s"}, "controller.rate"),
        ({"arm_angle": P, "delay": None}, "controller.delay"),
        ({"arm_angle": P | {"filter": float("inf")}}, "controller.arm_angle.filter"),
        ({"arm_angle": P | {"derivative_span": "2 rad"}}, "derivative_span"),
    ],
)
def test_a_table_that_makes_no_sense_is_refused_in_one_line(table, words):
    with pytest.raises(InputError, match=words) as refusal:
        law_from_table(table, "current")
    assert "\n" not in str(refusal.value)


def test_a_signal_that_the_arm_does_not_measure_is_refused(tmp_path: Path):
    file = tmp_path / "arm.toml"
    text = shipped_arms()["cu-rigid"].read_text(encoding="utf-8")
    file.write_text(f"{text}\n[controller.tip_deflection]\nproportional = 1.0\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"arm.toml: controller.tip_deflection .*\[sensors.tip_deflection\]"):
        Arm.load(file)


@pytest.mark.parametrize("name", sorted(shipped_arms()))
def test_an_arm_file_keeps_the_law(tmp_path: Path, name: str):
    arm = Arm.load(name)
    law = ControlLaw(
        (Feedback("arm_angle", (0.1, "kp"), ("ki",), (1 / 3,), 0.1, 0.2, 0.3), Feedback("motor_speed", (2.0,), (3.0,), (4.0,))),
        limit=0.7,
        rate=1e3,
        delay=1e-3,
    )
    for stated in (arm.controller, law, ControlLaw((Feedback("arm_angle", ("K1",)),))):
        if stated is not None and set(stated.signals) <= set(arm.sensors):
            replace(arm, controller=stated).save(tmp_path / "arm.toml")
            assert Arm.load(tmp_path / "arm.toml").controller == stated


@pytest.mark.parametrize("factor", ["243 V*s/rad", "2 mV/deg", "0.3 kg", "-1.1 1/s", 1 / 3, "1e-300 V"])
def test_a_factor_keeps_its_unit_in_the_arm_file(tmp_path: Path, factor: str | float):
    law = law_from_table({"arm_angle": {"proportional": ["kp", factor]}}, "voltage")
    replace(Arm.load("cu-rigid"), controller=law).save(tmp_path / "arm.toml")
    again = Arm.load(tmp_path / "arm.toml").controller
    assert again == law
    before, after = (one.feedback[0].proportional[1] for one in (law, again))
    assert getattr(after, "unit", "") == getattr(before, "unit", "")
    assert (getattr(after, "unit", "") != "") == isinstance(factor, str)


def test_arms_without_a_law_have_none(tmp_path: Path):
    Arm.load("thesis").save(tmp_path / "arm.toml")
    assert Arm.load(tmp_path / "arm.toml").controller is None
    assert not re.search("controller", (tmp_path / "arm.toml").read_text(encoding="utf-8"))
