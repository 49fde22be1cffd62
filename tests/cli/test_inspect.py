"""`flexarm inspect`: tables, JSON and page of what recordings hold, and the exit code."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cli_stand_ins import needs_plots

from flexarm_env.arm import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.recordings.recording import Recording


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Recordings of a rigid arm in two folders: sound ones, and one with readings that were lost for a moment."""
    made = tmp_path_factory.mktemp("inspected")
    arm = Arm.load("cu-rigid")
    for place in ("sound", "faulty"):
        (made / place).mkdir()
    for name in ("pulse", "square"):
        simulate(arm, name, duration=2.0, rate=200.0).write(made / "sound" / f"{name}.csv")
    run = simulate(arm, "pulse", duration=2.0, rate=200.0)
    angle = run.signals["arm_angle"].copy()
    angle[300:305] = 0.0
    replace(run, signals=run.signals | {"arm_angle": angle}).write(made / "faulty" / "lost.csv")
    return made


def test_sound_recordings_exit_0_with_tables(flexarm, folder):
    assert flexarm("inspect", folder / "sound", "--arm", "cu-rigid") == 0
    assert flexarm.out.startswith("No fault in 2 recordings.")
    for text in ("pulse", "square", "200.0 Hz", "arm angle", "resolution", "torque_constant", "coulomb", "near the truth"):
        assert text in flexarm.out
    assert flexarm.err == ""


def test_a_fault_exits_1_and_is_named_with_the_line_that_mends_it(flexarm, folder):
    assert flexarm("inspect", folder / "faulty", "--arm", "cu-rigid", "--json", "-") == 1
    (fault,) = json.loads(flexarm.out)["faults"]
    assert (fault["signal"], fault["fault"], fault["unit"]) == ("arm_angle", "dropout", "rad")
    assert fault["samples"] == list(range(300, 305))
    assert fault["hint"] in flexarm.err
    assert flexarm.err.startswith("1 fault in 1 recording.")


def test_the_json_has_the_facts_of_the_tables_in_si_units(flexarm, folder):
    assert flexarm("inspect", folder / "sound", "--arm", "cu-rigid", "--json", "-") == 0
    found = json.loads(flexarm.out)
    assert found["command"] == "inspect"
    assert [one["name"] for one in found["files"]] == ["pulse", "square"]
    assert found["extents"]["pulse"]["rate"] == {"value": pytest.approx(200.0), "unit": "Hz"}
    assert found["extents"]["pulse"]["samples"] == 400
    assert found["faults"] == []
    arm = Arm.load("cu-rigid")
    angles = [one for one in found["signals"] if one["signal"] == "arm_angle"]
    assert [one["recording"] for one in angles] == ["pulse", "square"]
    run = simulate(arm, "pulse", duration=2.0, rate=200.0)
    assert (angles[0]["low"], angles[0]["high"]) == (run.signals["arm_angle"].min(), run.signals["arm_angle"].max())
    assert angles[0]["resolution"] == 0.0  # nor does the arm's sensor have steps
    assert angles[0]["noise"] == pytest.approx(arm.sensors["arm_angle"]["noise"], rel=0.2)
    assert angles[0]["stated_noise"] == arm.sensors["arm_angle"]["noise"]
    assert (angles[0]["unit"], angles[0]["measured"]) == ("rad", 1.0)
    limits = found["excitation"]
    assert limits["constants"]["drive.torque_constant"]["unit"] == "Nm/A"
    assert limits["effects"]["coulomb"]["limit"] > 0.0
    assert {"unit", "typical", "parameter", "limit_is", "state"} <= set(limits["effects"]["saturation"])
    assert np.all([one["half_width"] <= one["prior_half_width"] for one in limits["constants"].values()])


@needs_plots
def test_the_page_is_written_for_faulty_recordings_too(flexarm, folder, tmp_path):
    page = tmp_path / "inspection.html"
    assert flexarm("inspect", folder / "faulty", "--arm", "cu-rigid", "--report", page) == 1
    text = page.read_text()
    assert "1 fault in 1 recording." in text
    assert "flexarm inspect" in text
    assert "--arm cu-rigid" in text


def test_bad_input_exits_2_with_one_line(flexarm, folder):
    assert "driven by current" in flexarm.refused("inspect", folder / "sound", "--arm", "thesis")
    assert "no_such" in flexarm.refused("inspect", folder / "no_such.csv")


def held(folder: Path, place: Path, kept: str) -> Path:
    """Write the square wave with the command, the signals or all held at their first value."""
    run = Recording.read(folder / "sound" / "square.csv")
    if kept != "signals":
        run = replace(run, command=np.full(len(run), run.command[0]))
    if kept != "command":
        run = replace(run, signals={signal: np.full(len(run), values[0]) for signal, values in run.signals.items()})
    run.write(place)
    return place


@pytest.mark.parametrize("kept", ["signals", "all"])
def test_recordings_without_motion_are_insufficient(flexarm, folder, tmp_path, kept):
    still = held(folder, tmp_path / "still.csv", kept)
    assert flexarm("inspect", still, "--arm", "cu-rigid", "--json", tmp_path / "found.json") == 1
    assert flexarm.out.startswith("No fault in 1 recording. Insufficient for a diagnosis.")
    assert "nothing moves beyond the noise" in flexarm.out
    found = json.loads((tmp_path / "found.json").read_text())
    assert found["insufficient"] is True
    assert found["excitation"]["effects"] == found["excitation"]["constants"] == {}


def test_signals_that_keep_one_value_are_no_rest_of_the_arm(flexarm, folder, tmp_path):
    words = "still: every signal keeps one value while the command changes"
    for kept, is_said in (("signals", True), ("all", False)):
        flexarm("inspect", held(folder, tmp_path / "still.csv", kept), "--arm", "cu-rigid")
        assert (words in " ".join(flexarm.out.split())) == is_said


@pytest.mark.parametrize("command", ["inspect", "compare"])
def test_a_command_that_keeps_one_value_is_noted(flexarm, folder, tmp_path, command):
    words = "in every row, which explains a release or a single step alone: was it recorded?"
    assert flexarm(command, held(folder, tmp_path / "held.csv", "command"), "--arm", "cu-rigid") == 0
    assert words in " ".join(flexarm.out.split())
    assert flexarm(command, folder / "sound", "--arm", "cu-rigid") == 0
    assert words not in " ".join(flexarm.out.split())


@pytest.mark.parametrize("rows", [0, 1, 2])
def test_a_row_or_two_are_refused(flexarm, folder, tmp_path, rows):
    lines = (folder / "sound" / "square.csv").read_text().splitlines()[: 1 + rows]
    (tmp_path / "few.csv").write_text("\n".join([*lines, ""]))
    assert "few" in flexarm.refused("inspect", tmp_path / "few.csv", "--arm", "cu-rigid")
