"""Conditions that a file states in columns of equal numbers or in scalars, such as the gains of its controller."""

from __future__ import annotations

from pathlib import Path

import pytest
import scipy.io

from flexarm_env.errors import InputError
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.recording import Recording

COLUMNS = {
    "time": {"column": "t", "unit": "s"},
    "current": {"column": "i", "unit": "A"},
    "arm_angle": {"column": "phi", "unit": "rad"},
    "conditions": {"K1": {"column": "P", "unit": "mV/deg", "sign": -1, "scale": 2.0}, "load": {"column": "m", "unit": "g"}},
}
TEXT = "t,i,phi,P,m\n0,0,0,{},250\n0.1,1,0.1,{},250\n0.2,1,0.2,{},250\n"


def read(tmp_path: Path, text: str, columns: dict = COLUMNS) -> Recording:
    (tmp_path / "run.csv").write_text(text)
    return Recording.read(tmp_path / "run.csv", columns)


def test_columns_of_equal_numbers_are_conditions_in_si(tmp_path):
    found = read(tmp_path, TEXT.format(6, 6, 6))
    assert found.conditions == pytest.approx({"K1": -12e-3 * 180 / 3.141592653589793, "load": 0.25})
    assert list(found.signals) == ["arm_angle"]


def test_they_are_written_and_read_back(tmp_path):
    found = read(tmp_path, TEXT.format(6, 6, 6))
    found.write(tmp_path / "again.csv")
    assert Recording.read(tmp_path / "again.csv").conditions == found.conditions


def test_scalars_of_a_matlab_file_are_conditions(tmp_path):
    scipy.io.savemat(tmp_path / "run.mat", {"t": [0.0, 0.1, 0.2], "i": [1.0, 1.0, 1.0], "q": [0.0, 1.0, 2.0], "kp": 160.18})
    columns = {name: {"variable": place, "unit": unit} for name, place, unit in (("time", "t", "s"), ("current", "i", "A"))}
    columns |= {"arm_angle": {"variable": "q", "unit": "rad"}, "conditions": {"kp": {"variable": "kp", "unit": "1/ms"}}}
    assert Recording.read(tmp_path / "run.mat", columns).conditions == pytest.approx({"kp": 160180.0})


def test_a_condition_without_a_unit_is_a_bare_number(tmp_path):
    columns = COLUMNS | {"conditions": {"trial": {"column": "P", "unit": "1"}}}
    assert read(tmp_path, TEXT.format(6, 6, 6), columns).conditions == {"trial": 6.0}


def stated(tmp_path: Path, name: str, entry: dict) -> float:
    columns = COLUMNS | {"conditions": {name: {"column": "m"} | entry}}
    return read(tmp_path, TEXT.format(6, 6, 6), columns).conditions[name]


@pytest.mark.parametrize(
    ("name", "entry", "found"),
    [
        ("payload", {"unit": "g"}, 0.25),
        ("payload", {"unit": "g", "scale": 2.0}, 0.5),
        ("payload", {"unit": "N", "scale": "0.1 kg/N"}, 25.0),
        ("payload", {"unit": "1", "scale": 1e-3}, 0.25),
        ("payload", {"unit": "1", "scale": "1 g"}, 0.25),
        ("start", {"unit": "ms"}, 0.25),
    ],
)
def test_a_payload_and_a_start_are_in_kg_and_s(tmp_path, name, entry, found):
    assert stated(tmp_path, name, entry) == pytest.approx(found)


@pytest.mark.parametrize(
    ("name", "entry", "words"),
    [
        ("payload", {"unit": "N"}, "unit 'N' does not convert to kg; write one of kg, g"),
        ("payload", {"unit": "mm"}, "unit 'mm' does not convert to kg"),
        ("payload", {"unit": "degC"}, "unit 'degC' does not convert to kg"),
        ("payload", {"unit": "1", "scale": "2 rad"}, "unit 'rad' does not convert to kg"),
        ("payload", {"unit": "kg", "scale": "2 rad"}, "unit 'kg × rad' does not convert to kg"),
        ("start", {"unit": "kg"}, "unit 'kg' does not convert to s"),
    ],
)
def test_a_payload_and_a_start_of_another_quantity_are_refused(tmp_path, name, entry, words):
    with pytest.raises(InputError, match=f"condition '{name}': {words}"):
        stated(tmp_path, name, entry)


def test_the_mean_of_numbers_that_differ_is_a_condition_where_it_is_wanted(tmp_path):
    conditions = {"supply": {"column": "P", "unit": "mV", "mean": True}}
    found = read(tmp_path, TEXT.format(7200, 7100, 7600), COLUMNS | {"conditions": conditions})
    assert found.conditions == pytest.approx({"supply": 7.3})
    assert "condition 'supply' is the mean of 'P', 7300 mV of 7100 to 7600" in found.notes
    equal = read(tmp_path, TEXT.format(7200, 7200, 7200), COLUMNS | {"conditions": conditions})
    assert equal.conditions == pytest.approx({"supply": 7.2})
    assert not equal.notes


def test_a_mean_is_true_or_left_out_and_of_a_condition(tmp_path):
    wrong = COLUMNS | {"conditions": {"K1": {"column": "P", "unit": "V", "mean": "yes"}}}
    with pytest.raises(InputError, match=r"conditions.K1: mean is 'yes'; write true"):
        read(tmp_path, TEXT.format(6, 6, 7), wrong)
    with pytest.raises(InputError, match="arm_angle: unknown key 'mean'"):
        read(tmp_path, TEXT.format(6, 6, 6), COLUMNS | {"arm_angle": {"column": "phi", "unit": "rad", "mean": True}})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (TEXT.format(6, 6, 7), r"condition 'K1': 'P' is not one number throughout; write split = true"),
        (f"# K1 = 3\n{TEXT.format(6, 6, 6)}", "condition 'K1' comes twice"),
        (TEXT.format(6, "x", 6), "column 'K1'"),
        (TEXT.format(6, 6, 6).replace(",P,", ",Q,"), "column 'K1': no 'P'"),
    ],
)
def test_a_condition_that_is_none_is_refused(tmp_path, text, words):
    with pytest.raises(InputError, match=words) as refusal:
        read(tmp_path, text)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("conditions", "words"),
    [
        (3, "conditions: is not a table"),
        ({"K1": 6.0}, r"conditions.K1: is 6.0; write \{column"),
        ({"K 1": {"column": "P", "unit": "1"}}, "'K 1'"),
        ({"time": {"column": "P", "unit": "1"}}, "'time' is a column"),
        ({"K1": {"column": "P"}}, "has no unit"),
        ({"K1": {"variable": "P", "unit": "1"}}, "keep to one kind"),
    ],
)
def test_an_entry_that_makes_no_sense_is_refused(conditions, words):
    with pytest.raises(InputError, match=words):
        load_columns(COLUMNS | {"conditions": conditions})


def test_a_controller_beside_the_map_needs_its_signals(tmp_path):
    lines = [
        '[columns]\ntime = { index = 0, unit = "s" }',
        'current = { index = 1, unit = "A" }',
        'arm_angle = { index = 2, unit = "rad" }',
    ]
    map_file = tmp_path / "map.toml"
    map_file.write_text("\n".join([*lines, "[controller.motor_speed]\nproportional = 1.0"]))
    with pytest.raises(InputError, match=r"map.toml: controller.motor_speed .*\[columns\]"):
        load_columns(map_file)
    map_file.write_text("\n".join([*lines, "[controller.arm_angle]\nproportional = 1.0"]))
    assert load_columns(map_file).controller.signals == ("arm_angle",)
