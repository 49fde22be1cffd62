"""Conditions in a file beside a recording, and a command that no column states."""

from __future__ import annotations

import numpy as np
import pytest
from recording_files import GOOD, LOGGER, refusal, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.recording import Recording

STATED = "[conditions]\npayload = '300 g'\nkp = 400\nsupply = '7.4 V'\ntorque_enabled = true\n"


def test_conditions_beside_a_recording_are_its_own(tmp_path):
    save(tmp_path, STATED, "run.toml")
    run = Recording.read(save(tmp_path, GOOD))
    assert run.conditions == {"payload": 0.3, "kp": 400.0, "supply": 7.4, "torque_enabled": 1.0}
    assert run.notes == ("run.toml states payload = 0.3 kg, kp = 400, supply = 7.4 V, torque_enabled = 1",)
    assert Recording.read(save(tmp_path, GOOD, "other.csv")).conditions == {}
    (listed, other) = Recording.read_all(tmp_path)
    assert (listed.name, other.name) == ("other", "run")


def test_they_add_to_those_of_the_file(tmp_path):
    save(tmp_path, "[conditions]\nkp = 400\n", "run.toml")
    path = save(tmp_path, "# payload = 0.2 kg\n" + GOOD)
    assert Recording.read(path).conditions == {"payload": 0.2, "kp": 400.0}
    save(tmp_path, STATED, "run.toml")
    assert refusal(path) == "condition 'payload' comes twice, in the file and in run.toml; keep one of the two"


@pytest.mark.parametrize("content", ["[columns]\n", "[drive]\n[hub]\n", "name = 'a'\n[sensors.arm_angle]\n"])
def test_an_arm_or_a_map_beside_a_recording_states_no_conditions(tmp_path, content):
    save(tmp_path, content, "run.toml")
    assert Recording.read(save(tmp_path, GOOD)).conditions == {}


def test_a_map_beside_a_recording_hides_no_conditions(tmp_path):
    beside = save(tmp_path, "[columns]\narm_angle = {sign = -1}\n[conditions]\npayload = '0.3 kg'\n", "run.toml")
    path = save(tmp_path, GOOD)
    for columns in (None, beside):
        with pytest.raises(InputError, match=r"has .conditions. beside .columns.") as caught:
            Recording.read(path, columns)
        assert str(caught.value).startswith(f"{beside}: ")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("[condition]\nkp = 1\n", "has no [conditions] table for run.csv beside it"),
        ("conditions = 3\n", "[conditions] is not a table"),
        ("[conditions]\nkp = 1\n[other]\n", "[conditions] has 'other' beside it"),
        ("[conditions]\nkp = [1]\n", "condition 'kp' is [1]; write a number"),
        ("[conditions]\nkp = 'much'\n", "condition 'kp': 'much' is not a number"),
        ("[conditions]\npayload = '1 m'\n", "condition 'payload': unit 'm' does not convert to kg"),
        ("[conditions]\npaylod = '0.3 kg'\n", "unknown condition 'paylod'; did you mean 'payload'"),
        ("[conditions]\npayload = true\n", "condition 'payload' is True; write a number in kg"),
        ("[conditions]\npayload = -1\n", "condition 'payload' is -1"),
        ("[conditions]\n'k p' = 1\n", "condition 'k p': write its name"),
        ("[conditions]\nkp = nan\n", "condition 'kp' is nan"),
        ("[conditions\n", "is not TOML"),
    ],
)
def test_a_fault_in_it_is_told_with_its_name(tmp_path, content, words):
    beside, path = save(tmp_path, content, "run.toml"), save(tmp_path, GOOD)
    with pytest.raises(InputError) as caught:
        Recording.read(path)
    assert str(caught.value).startswith(f"{beside}: ")
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


JOINED = {
    "time": {"column": "t", "unit": "s"},
    "current": {"file": "*_command.csv", "column": "i", "unit": "A"},
    "arm_angle": {"file": "*_encoder.csv", "column": "phi", "unit": "rad"},
}


@pytest.mark.parametrize("name", ["m", "m_command", "m_encoder"])
def test_conditions_of_a_joined_recording_have_its_name_or_that_of_a_file(tmp_path, name):
    path = save(tmp_path, "t,i\n0,1\n1,1\n", "m_command.csv")
    save(tmp_path, "t,phi\n0,0\n1,1\n", "m_encoder.csv")
    save(tmp_path, STATED, f"{name}.toml")
    (run,) = Recording.read_all(tmp_path, JOINED)
    assert (run.name, run.conditions["payload"]) == ("m", 0.3)
    assert run.notes[-1].startswith(f"{name}.toml states payload = 0.3 kg")
    save(tmp_path, "[conditions]\npayload = '0.3 kg'\n", "m.toml")
    assert Recording.read(path, JOINED).conditions["payload"] == 0.3


def test_two_files_of_conditions_that_differ_are_refused(tmp_path):
    path = save(tmp_path, "t,i\n0,1\n1,1\n", "m_command.csv")
    save(tmp_path, "t,phi\n0,0\n1,1\n", "m_encoder.csv")
    save(tmp_path, "[conditions]\nkp = 3\n", "m.toml")
    beside = save(tmp_path, "[conditions]\nkp = 4\n", "m_command.toml")
    with pytest.raises(InputError) as caught:
        Recording.read(path, JOINED)
    assert str(caught.value) == f"{beside}: condition 'kp' is 4, but 3 in another file beside the recording; correct one"


def test_a_command_that_no_column_states(tmp_path):
    path = save(tmp_path, "t;phi\n0;0\n10;9\n20;18\n")
    columns = {"delimiter": ";", "time": LOGGER["time"], "current": {"value": "20 mA"}, "arm_angle": LOGGER["arm_angle"]}
    run = Recording.read(path, columns)
    assert run.command.tolist() == [0.02, 0.02, 0.02]
    assert run.signals["arm_angle"][1] == pytest.approx(-np.radians(9))


def test_it_refines_a_header_that_has_no_command(tmp_path):
    path = save(tmp_path, "time [s],arm_angle [rad]\n0,1\n1,2\n")
    run = Recording.read(path, {"current": {"value": 0}})
    assert (run.input_kind, run.command.tolist()) == ("current", [0.0, 0.0])
    assert "current" in refusal(save(tmp_path, GOOD), columns={"current": {"value": 0}})


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ({"value": "x"}, "value: 'x' is not a number"),
        ({"value": True}, "value: is True; write a number"),
        ({"value": float("inf")}, "value is inf; write the command of every row, such as '0 A'"),
        ({"value": 0, "unit": "A"}, "has 'value' and 'unit'; the value alone makes the command"),
    ],
)
def test_a_command_without_a_number_is_refused(tmp_path, entry, words):
    with pytest.raises(InputError, match=r"\[columns\] current") as caught:
        Recording.read(save(tmp_path, GOOD), {"current": entry})
    assert words in str(caught.value)


def test_a_signal_has_no_value(tmp_path):
    with pytest.raises(InputError, match="unknown key 'value'"):
        Recording.read(save(tmp_path, GOOD), {"arm_angle": {"value": 1.0}})


def test_a_tip_deflection_in_degrees(tmp_path):
    """An angle at the hub's axis times the beam's length is the deflection."""
    path = save(tmp_path, "t,i,alpha\n0,0,0\n1,0,9\n")
    columns = {
        "time": {"column": "t", "unit": "s"},
        "current": {"column": "i", "unit": "A"},
        "tip_deflection": {"column": "alpha", "unit": "deg", "scale": "0.4 m/rad"},
    }
    assert Recording.read(path, columns).signals["tip_deflection"][1] == pytest.approx(0.4 * np.pi / 20)
