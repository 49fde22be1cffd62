"""Recordings at fault: a diagnosis names the fault at once and no effect; other commands go on, and say it."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from cli_stand_ins import needs_plots

from flexarm_env import Arm, Recording, diagnose, simulate

MEND = 'strain_base = { range = ["-1.5 V", "1.5 V"] }'


@pytest.fixture(scope="module")
def square() -> Recording:
    return simulate(Arm.load("thesis"), "square", duration=4.0, rate=250.0, seed=2)


@pytest.fixture
def clipped(square, tmp_path):
    signals = square.signals | {"strain_base": np.clip(square.signals["strain_base"], -1.5, 1.5)}
    replace(square, signals=signals).write(tmp_path / "clipped.csv")
    return tmp_path / "clipped.csv"


@pytest.fixture
def two_runs(square, tmp_path):
    square.write(tmp_path / "one.csv")
    lines = (tmp_path / "one.csv").read_text().splitlines()
    (tmp_path / "two.csv").write_text("\n".join([*lines, *lines[1:], ""]))
    return tmp_path / "two.csv"


def test_a_diagnosis_names_the_fault_and_no_effect(flexarm, clipped, tmp_path):
    assert flexarm("diagnose", clipped, "--json", tmp_path / "d.json", "--save", tmp_path / "arm.toml") == 1
    found = json.loads((tmp_path / "d.json").read_text())
    assert (found["verdict"], found["effects"], found["ranking"]) == ("recordings", [], [])
    (fault,) = found["recordings"]
    expected = {"file": str(clipped), "signal": "strain_base", "fault": "rail", "value": 1.5, "hint": MEND}
    assert expected.items() <= fault.items()
    assert set(found["error"].values()) == {None}
    assert "strain_base stands at its extreme of ±1.5 V" in flexarm.out
    assert MEND in flexarm.out
    assert not (tmp_path / "arm.toml").exists()
    assert "arm.toml is not written" in flexarm.err


def test_two_runs_in_a_file_are_a_verdict_too(flexarm, two_runs, tmp_path):
    assert flexarm("diagnose", two_runs, "--json", tmp_path / "d.json") == 1
    (fault,) = json.loads((tmp_path / "d.json").read_text())["recordings"]
    assert (fault["fault"], fault["signal"], fault["value"]) == ("restart", "time", pytest.approx(3.996))
    assert "row 1002" in fault["message"]
    assert "two runs" in flexarm.out


def test_what_two_runs_leave_unwritten_is_said(flexarm, two_runs, tmp_path):
    arm, commands = tmp_path / "arm.toml", tmp_path / "next.csv"
    assert flexarm("diagnose", two_runs, "--save", arm, "--next-run", commands) == 1
    assert f"{arm} is not written" in flexarm.err
    assert f"{commands} is not written" in flexarm.err
    assert not arm.exists()
    assert not commands.exists()


def test_an_inspection_of_two_runs_names_their_fault(flexarm, two_runs, tmp_path):
    assert flexarm("inspect", two_runs, "--json", tmp_path / "i.json") == 1
    found = json.loads((tmp_path / "i.json").read_text())
    assert [(fault["fault"], fault["signal"], fault["value"]) for fault in found["faults"]] == [
        ("restart", "time", pytest.approx(3.996))
    ]
    assert (found["signals"], found["extents"]) == ([], {})
    assert flexarm.out.startswith("1 fault. The file cannot be read as one recording")
    assert "row 1002" in flexarm.out
    assert flexarm.err == ""


@pytest.mark.parametrize("command", [["compare"], ["fit"], ["add", "backlash"]])
def test_other_commands_refuse_two_runs_with_the_row(flexarm, two_runs, command):
    assert flexarm(*command, two_runs) == 2
    assert f"{two_runs}: row 1002, column 'time': the clock starts again" in flexarm.err
    assert "sort" not in flexarm.err


def test_compare_goes_on_with_a_note(flexarm, clipped, tmp_path):
    assert flexarm("compare", clipped, "--json", tmp_path / "c.json") == 0
    (note, *_) = json.loads((tmp_path / "c.json").read_text())["notes"]
    assert note.startswith("clipped: strain_base stands at its extreme")
    assert MEND in note


def test_fit_and_add_go_on_with_a_note_on_stderr(flexarm, identify, clipped):
    identify.inspects = True
    for command in (["fit"], ["add", "backlash"]):
        assert flexarm(*command, clipped) == 0
        assert "Note: clipped: strain_base stands at its extreme" in flexarm.err


@needs_plots
def test_the_page_names_the_fault(flexarm, clipped, two_runs, tmp_path):
    for command, file, words in (
        ("diagnose", clipped, "stands at its extreme"),
        ("diagnose", two_runs, "two runs"),
        ("inspect", two_runs, "two runs"),
    ):
        assert flexarm(command, file, "--report", tmp_path / "page.html") == 1
        text = (tmp_path / "page.html").read_text()
        assert "Faults of the recordings" in text
        assert words in text
        assert "figure-glance-fall" not in text


def test_python_gets_the_faults(square):
    signals = square.signals | {"motor_speed": np.zeros(len(square))}
    found = diagnose(Arm.load("thesis"), [replace(square, signals=signals)], jobs=1)
    assert (found.verdict, found.effects) == ("recordings", [])
    assert [(fault.kind, fault.signal) for fault in found.recordings] == [("constant", "motor_speed")]
    assert found.arm is found.nominal
