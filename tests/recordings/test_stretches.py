"""Runs that are cut where a condition changes, such as those of a servo whose torque is switched off."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env import Arm, simulate
from flexarm_env.errors import InputError
from flexarm_env.identify.explain.compare import compare
from flexarm_env.recordings.recording import Recording
from flexarm_env.recordings.stretches import MOST_STRETCHES, stretches_of

COLUMNS = {
    "time": {"column": "t", "unit": "s"},
    "current": {"column": "i", "unit": "A"},
    "arm_angle": {"column": "phi", "unit": "rad"},
    "conditions": {"load": {"column": "m", "unit": "g", "split": True}},
}
LOAD = {"payload": 0.49}


def text_of(loads: list[float], angles: list[float] | None = None) -> str:
    angles = angles or [0.1 * k for k in range(len(loads))]
    rows = (f"{0.1 * k:g},{k},{angle:g},{load:g}" for k, (load, angle) in enumerate(zip(loads, angles, strict=True)))
    return "\n".join(("t,i,phi,m", *rows, ""))


def read_all(folder: Path, text: str, columns: dict[str, Any] = COLUMNS) -> list[Recording]:
    (folder / "run.csv").write_text(text)
    return Recording.read_all(folder / "run.csv", columns)


def test_a_run_is_cut_where_its_condition_changes(tmp_path):
    first, second, third = read_all(tmp_path, text_of([250, 250, 0, 0, 0, 250, 250]))
    assert [one.name for one in (first, second, third)] == ["run part 1", "run part 2", "run part 3"]
    assert first.conditions == {"load": 0.25}
    assert second.conditions == pytest.approx({"load": 0.0, "start": 0.2})
    assert third.conditions == pytest.approx({"load": 0.25, "start": 0.5})
    assert second.time.tolist() == pytest.approx([0.0, 0.1, 0.2])
    assert second.command.tolist() == [2.0, 3.0, 4.0]
    assert second.notes[-1] == "part 2 of 3, 0.2 to 0.5 s of the run, in which load = 0"


def test_a_condition_that_never_changes_cuts_nothing(tmp_path):
    (only,) = read_all(tmp_path, text_of([250, 250, 250]))
    assert (only.name, only.conditions, only.notes) == ("run", {"load": 0.25}, ())
    assert Recording.read(tmp_path / "run.csv", COLUMNS).conditions == {"load": 0.25}


def test_one_recording_cannot_be_read_of_several_stretches(tmp_path):
    (tmp_path / "run.csv").write_text(text_of([250, 250, 0, 0]))
    with pytest.raises(InputError, match="is split in 2 recordings by its conditions; read all by read_all"):
        Recording.read(tmp_path / "run.csv", COLUMNS)


def test_an_angle_is_unwrapped_over_the_whole_run(tmp_path):
    angles = [3.0, 3.1, -3.1, -3.0]  # past π, where the encoder starts over
    columns = COLUMNS | {"arm_angle": {"column": "phi", "unit": "rad", "wrap": "6.283185307 rad"}}
    found = read_all(tmp_path, text_of([1, 1, 0, 0], angles), columns)
    assert found[1].signals["arm_angle"] == pytest.approx([2 * math.pi - 3.1, 2 * math.pi - 3.0])


def test_true_and_false_of_a_condition_are_one_and_zero_and_of_a_signal_no_numbers(tmp_path):
    text = "t,i,phi,m\n0,0,0,True\n0.1,1,0,true\n0.2,1,0, FALSE\n0.3,1,0,False\n"
    columns = COLUMNS | {"conditions": {"on": {"column": "m", "unit": "1", "split": True}}}
    assert [one.conditions["on"] for one in read_all(tmp_path, text, columns)] == [1.0, 0.0]
    with pytest.raises(InputError, match="row 2, column 'arm_angle': 'True' is not a number"):
        read_all(tmp_path, "t,i,phi,m\n0,0,True,1\n0.1,1,False,1\n", columns)


def test_a_stretch_of_one_sample_or_without_a_reading_is_left_out(tmp_path):
    found = read_all(tmp_path, text_of([1, 1, 0, 2, 2]))
    assert [one.name for one in found] == ["run part 1", "run part 3"]
    rows = text_of([1, 1, 0, 0]).replace(",0.2,0", ",,0").replace(",0.3,0", ",,0")
    assert [one.name for one in read_all(tmp_path, rows)] == ["run part 1"]


def test_commands_alone_are_cut_too(tmp_path):
    columns = {name: entry for name, entry in COLUMNS.items() if name != "arm_angle"}
    (tmp_path / "run.csv").write_text(text_of([1, 1, 0, 0]))
    assert len(Recording.read_all(tmp_path / "run.csv", columns, require_signal=False)) == 2


@pytest.mark.parametrize(
    ("loads", "words"),
    [
        ([0, 1, 0, 1], "changes at every sample"),
        ([k // 2 for k in range(2 * MOST_STRETCHES + 2)], f"makes {MOST_STRETCHES + 1} stretches of one run"),
    ],
)
def test_a_condition_that_changes_too_often_is_refused(tmp_path, loads, words):
    with pytest.raises(InputError, match=words) as refusal:
        read_all(tmp_path, text_of(loads))
    assert str(refusal.value).startswith(str(tmp_path / "run.csv"))


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ({"split": "yes"}, r"conditions.load: split is 'yes'; write true"),
        ({"split": True, "mean": True}, "conditions.load: has both 'mean' and 'split'; keep one"),
    ],
)
def test_a_split_is_true_and_stands_alone(tmp_path, entry, words):
    columns = COLUMNS | {"conditions": {"load": {"column": "m", "unit": "g"} | entry}}
    with pytest.raises(InputError, match=words):
        read_all(tmp_path, text_of([1, 1]), columns)


def test_a_condition_has_a_number_of_each_sample(tmp_path):
    scipy.io.savemat(tmp_path / "run.mat", {"t": [0.0, 0.1, 0.2], "i": [1.0, 1.0, 1.0], "q": [0.0, 1.0, 2.0], "on": [1.0, 0.0]})
    columns = {name: {"variable": place, "unit": unit} for name, place, unit in (("time", "t", "s"), ("current", "i", "A"))}
    columns |= {
        "arm_angle": {"variable": "q", "unit": "rad"},
        "conditions": {"on": {"variable": "on", "unit": "1", "split": True}},
    }
    with pytest.raises(InputError, match="condition 'on': 'on' has 2 numbers for 3 samples; write mean = true"):
        Recording.read_all(tmp_path / "run.mat", columns)


def test_a_run_in_several_files_is_not_split(tmp_path):
    columns = COLUMNS | {"arm_angle": {"column": "phi", "unit": "rad", "file": "*_angle.csv"}}
    with pytest.raises(InputError, match=r"conditions\.load: split is of a run in one file"):
        read_all(tmp_path, text_of([1, 1, 0, 0]), columns)


@given(st.lists(st.sampled_from([0.0, 1.0]), min_size=2, max_size=60))
def test_the_parts_put_together_are_the_run(values):
    count = len(values)
    run = Recording.from_arrays("run", np.arange(count) * 0.01, "current", np.arange(count), {"arm_angle": np.arange(count)})
    try:
        parts = stretches_of(run, {"on": values})
    except InputError:
        assert all(one != other for one, other in pairwise(values))
        return
    rows = [int(row) for part in parts for row in part.command]
    dropped = [row for row in range(count) if row not in rows]
    assert rows == sorted(rows)
    assert all(values[row] != values[near] for row in dropped for near in (row - 1, row + 1) if 0 <= near < count)
    for part in parts:
        assert {values[int(row)] for row in part.command} == {part.conditions["on"]}


def servo_run(arm: Arm, seconds: float, seed: int) -> np.ndarray:
    """Simulate the angle [rad] of a servo with a mass at its link that is told to hold 1.2 rad, at 200 Hz."""
    time = np.arange(round(200 * seconds)) / 200
    goal = Recording.from_arrays("goal", time, "position", np.full(len(time), 1.2), {}, conditions=LOAD, require_signal=False)
    return simulate(arm, goal, seed=seed).signals["arm_angle"]


def test_a_servo_whose_torque_is_switched_off_falls_as_a_free_pendulum(tmp_path):
    """A log whose arm is lifted and dropped: the model that made both parts leaves no more than the encoder's steps."""
    arm = Arm.load("xl330-pendulum")
    lifted = servo_run(arm, 1.5, seed=3)
    # released at rest, where gravity has turned by as much as the arm was lifted
    turned = {"drive.enabled": 0.0, "link.hangs_at": arm.value("link.hangs_at") - float(lifted[-1])}
    dropped = servo_run(arm.with_values(turned), 2.0, seed=4) + lifted[-1]
    angles = np.concatenate([lifted, dropped])
    entries = [
        {"timestamp": 0.005 * k, "goal_position": 1.2, "position": angle, "input_volts": 7.4, "torque_enable": k < len(lifted)}
        for k, angle in enumerate(angles.tolist())
    ]
    log = tmp_path / "drop.json"
    log.write_text(json.dumps({"mass": LOAD["payload"], "length": 0.1, "kp": 400, "entries": entries}))
    parts = Recording.read_all(log, arm.columns)
    assert [part.conditions["torque_enabled"] for part in parts] == [1.0, 0.0]
    assert np.ptp(parts[1].signals["arm_angle"]) > 1.0
    assert compare(arm, parts).error < 1.5
    assert compare(arm, [replace(parts[1], conditions=LOAD)]).error > 20.0


def test_parts_of_files_of_one_name_in_folders_of_one_name_have_names_of_their_own(tmp_path):
    for folder in ("x/a", "y/a"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "run.csv").write_text(text_of([250, 250, 0, 0]))
    found = Recording.read_all([tmp_path / "x/a", tmp_path / "y/a"], COLUMNS)
    names = [one.name for one in found]
    assert len(set(names)) == len(names) == 4
    assert names[1] == f"{tmp_path / 'x/a/run.csv'}: run part 2"
