"""`flexarm diagnose --settings` prints the numbers of the method, and results name theirs."""

from __future__ import annotations

import json

import pytest

from flexarm_env.identify.settings import SETTINGS

AS_JSON = json.loads(json.dumps(SETTINGS.as_json()))


def test_settings_are_printed_without_recordings(flexarm, identify):
    assert flexarm("diagnose", "--settings") == 0
    assert identify.log == []
    shown = flexarm.out.splitlines()
    assert SETTINGS.digest() in shown[0]
    assert [line.strip() for line in shown if line.strip() in AS_JSON] == list(AS_JSON)
    for name, value, unit in (("held_out_share", "0.35", ""), ("window", "1", "s"), ("windows", "0.0001, 0.002, 0.02", "")):
        assert any(line.split()[: 1 + len(value.split())] == [name, *value.split()] and unit in line for line in shown)
    words = " ".join(flexarm.out.split())
    assert "how found" in words
    assert "not known" in words


def test_settings_are_written_as_json(flexarm, tmp_path):
    assert flexarm("diagnose", "--settings", "--json", tmp_path / "settings.json") == 0
    assert json.loads((tmp_path / "settings.json").read_text()) == AS_JSON
    assert flexarm("diagnose", "--settings", "--json", "-") == 0
    assert json.loads(flexarm.out) == AS_JSON
    assert "cannot write" in flexarm.refused("diagnose", "--settings", "--json", tmp_path)


def test_a_diagnosis_needs_recordings(flexarm):
    expected = flexarm.refused("compare").replace("compare", "diagnose")
    assert flexarm.refused("diagnose") == expected


@pytest.mark.parametrize("command", [["diagnose"], ["fit"], ["add", "backlash"]])
def test_results_carry_their_settings(flexarm, identify, runs, command):
    assert flexarm(*command, runs, "--json", "-") == 0
    assert json.loads(flexarm.out)["settings"] == AS_JSON
