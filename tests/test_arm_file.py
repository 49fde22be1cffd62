"""Arm files: whatever is written can be read, bit for bit."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

from flexarm_env.arm import Arm
from flexarm_env.arm_file import shipped_arms
from flexarm_env.arm_sections import SENSOR
from flexarm_env.arm_text import arm_text
from flexarm_env.effects import Catalogue, Effect, catalogue
from flexarm_env.errors import InputError
from flexarm_env.parameters import Parameter

#: Units that a parameter of one's own effect may have, as hard to read back as pint allows.
UNITS = ("1/rad", "1 / s", "1/rad**2", "rad/(N*m)", "N*m/(rad/s)**2", "(N*m)**0.5", "V/s", "m s^-2", "Ω", "%", "")


def bits(tables: Mapping[str, Mapping[str, float]]) -> dict[str, dict[str, str]]:
    return {name: {key: float(value).hex() for key, value in table.items()} for name, table in tables.items()}


def read_back(arm: Arm, folder: Path, known: Catalogue | None = None) -> Arm:
    arm.save(folder / "arm.toml")
    return Arm.load(folder / "arm.toml", known)


def complete(name: str, level: str) -> Arm:
    """Give a shipped arm every effect that it can have, at the low, typical or high end of its bounds."""
    arm = Arm.load(name)
    for effect in filter(arm.can_have, catalogue()):
        arm = arm.with_effect(effect, **{key: getattr(p, level) for key, p in arm.known[effect].parameters.items()})
    return arm


@pytest.mark.parametrize("level", ["low", "typical", "high"])
@pytest.mark.parametrize("name", sorted(shipped_arms()))
def test_every_effect_is_read_back_bit_for_bit(tmp_path, name, level):
    arm = complete(name, level)
    again = read_back(arm, tmp_path)
    assert bits(again.effects) == bits(arm.effects)
    assert bits(again.constants) == bits(arm.constants)
    assert bits(again.sensors) == bits(arm.sensors)


@pytest.mark.parametrize("level", ["low", "typical", "high"])
@pytest.mark.parametrize("name", sorted(shipped_arms()))
def test_every_quantity_is_written_with_its_unit(name, level):
    arm = complete(name, level)
    table = tomllib.loads(arm_text(arm))
    written = {f"{section}.{key}": value for section in arm.constants for key, value in table[section].items()}
    for kind in ("sensors", "effects"):
        written |= {f"{kind}.{name}.{key}": value for name, one in table[kind].items() for key, value in one.items()}
    del written["drive.input"]
    for path, value in written.items():
        parameter = arm.parameter(path)
        command = {"current": "A", "voltage": "V", "torque": "N*m", "position": "rad"}[arm.input]
        unit = (
            {"": command, "1/s": f"{command}/s"}.get(parameter.unit, parameter.unit) if parameter.of_command else parameter.unit
        )
        if isinstance(value, str):
            assert value == "auto" or value.split(" ", 1)[1] == unit, path
        else:
            assert parameter.is_count or math.isinf(value) or not unit, path


def test_a_quantity_of_the_command_is_written_in_the_unit_of_the_drive(tmp_path):
    table = tomllib.loads(arm_text(voltage_arm(tmp_path)))
    assert table["drive"]["limit"] == "10.0 V"
    assert table["effects"] == {"dead_zone": {"width": "0.1 V"}, "rate_limit": {"rate": "30.0 V/s"}}


@pytest.mark.parametrize("unit", UNITS)
def test_whatever_unit_an_effect_has_is_read_back(tmp_path, unit):
    class Own(Effect):
        """An effect of a person's own."""

        name = "own"
        equation = "τ = a"
        parameters: ClassVar = {"size": Parameter(unit, -math.inf, math.inf, 0.1, null=0.0)}
        looks_like = "nothing"

    known = catalogue().extended(Own)
    for value in (0.1, 1.0, -0.0, 5e-324, 1e300, 1e22, math.inf, -math.inf):
        arm = Arm.load("thesis", known).with_effect("own", size=value)
        assert bits(read_back(arm, tmp_path, known).effects) == bits(arm.effects)


@pytest.mark.parametrize("name", sorted(shipped_arms()))
def test_sensors_are_read_back_bit_for_bit(tmp_path, name):
    arm = Arm.load(name)
    odd = {f"sensors.{s}.{key}": np.float64(p.typical + 1 / 300) for s in arm.sensors for key, p in SENSOR.items()}
    arm = arm.with_values(odd)
    assert bits(read_back(arm, tmp_path).sensors) == bits(arm.sensors)


def test_fitted_intervals_and_origin_are_read_back(tmp_path):
    fitted: dict[str, Any] = {
        "effects.cogging.cycles": {"value": 9.0, "low": 1 / 3, "high": math.inf, "unit": "1/rad"},
        "sensors.arm_angle.gain": {"value": 1.01, "low": 1.0, "high": 1.02, "unit": ""},
    }
    origin = {"command": 'flexarm add "cogging"', "recordings": ["a.csv", "b.csv"], "seed": 0, "error": 1.02}
    arm = Arm.load("thesis").with_effect("cogging")
    arm = Arm(**{**vars(arm), "fitted": fitted, "origin": origin})
    again = read_back(arm, tmp_path)
    assert again.fitted == fitted
    assert again.origin == origin


@pytest.mark.parametrize(
    ("line", "instead", "words"),
    [
        ("name = ", 'name = ["x"]', "name = ['x'] is no text"),
        ("description = ", "description = {a = 1}", "description = {'a': 1} is no text"),
        ("name = ", 'name = "a\\u0000b"', "has a character that cannot be printed"),
        ("name = ", 'name = "a\\nb"', "has a character that cannot be printed"),
        ("elements = ", "elements = 2.5", "beam.elements = 2.5; write a whole number"),
    ],
)
def test_another_kind_of_value_is_refused(tmp_path, line, instead, words):
    Arm.load("thesis").save(tmp_path / "arm.toml")
    written = (tmp_path / "arm.toml").read_text().splitlines()
    kept = [instead if one.startswith(line) else one for one in written]
    (tmp_path / "arm.toml").write_text("\n".join(kept if kept != written else [instead, *written]))
    with pytest.raises(InputError, match=re.escape(words)):
        Arm.load(tmp_path / "arm.toml")


@pytest.mark.parametrize(
    ("entry", "path"),
    [
        ("[fitted]\na = 3", "a"),
        ('[fitted."hub.inertia"]\nvalue = 1.0', "hub.inertia"),
        ('[fitted."hub.inertia"]\nvalue = 1.0\nlow = "x"\nhigh = 2.0', "hub.inertia"),
        ('[fitted."hub.inertia"]\nvalue = 1.0\nlow = true\nhigh = 2.0', "hub.inertia"),
    ],
)
def test_an_interval_that_is_none_is_refused(tmp_path, entry, path):
    Arm.load("thesis").save(tmp_path / "arm.toml")
    with (tmp_path / "arm.toml").open("a") as file:
        file.write(f"\n{entry}\n")
    with pytest.raises(InputError, match=f"fitted.{path} lacks a number"):
        Arm.load(tmp_path / "arm.toml")


def test_an_effect_s_count_is_a_whole_number():
    with pytest.raises(InputError, match=re.escape("effects.higher_modes.elements = 2.5; write a whole number")):
        Arm.load("thesis").with_effect("higher_modes", elements=2.5)


VOLTAGE = """
[drive]
input = "voltage"
resistance = "4.2 ohm"
torque_constant = 0.00768
gear_ratio = 70
motor_inertia = 0
limit = {limit}
[hub]
inertia = 0.002
[sensors.arm_angle]
[effects.dead_zone]
width = {width}
[effects.rate_limit]
rate = {rate}
"""
WRITTEN = {"limit": 10.0, "width": 0.1, "rate": 30.0}


def voltage_arm(folder: Path, **values: str) -> Arm:
    (folder / "arm.toml").write_text(VOLTAGE.format(**(WRITTEN | values)))
    return Arm.load(folder / "arm.toml")


@pytest.mark.parametrize(
    "values", [{"limit": '"10 V"'}, {"width": '"100 mV"'}, {"rate": '"30 V/s"'}, {"rate": '"0.03 V/ms"'}, {"rate": '"30.0 1/s"'}]
)
def test_a_quantity_of_the_command_may_have_its_unit(tmp_path, values):
    assert bits(voltage_arm(tmp_path, **values).effects) == bits(voltage_arm(tmp_path).effects)
    assert voltage_arm(tmp_path, **values).value("drive.limit") == 10.0


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"limit": '"10 A"'}, "drive.limit: unit 'A' does not convert to V"),
        ({"width": '"0.1 A"'}, "effects.dead_zone.width: unit 'A' does not convert to V"),
        ({"rate": '"30 A/s"'}, "effects.rate_limit.rate: unit 'A/s' does not convert to V/s"),
        ({"width": "-1"}, "effects.dead_zone.width = -1 V is out of bounds: allowed are 0 to 10000 V"),
        ({"limit": '"-3 V"'}, "drive.limit = -3 V is out of bounds"),
    ],
)
def test_a_quantity_of_another_command_is_refused(tmp_path, values, words):
    with pytest.raises(InputError, match=re.escape(words)):
        voltage_arm(tmp_path, **values)
