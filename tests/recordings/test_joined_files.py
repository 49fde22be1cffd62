"""Several files as one recording, one signal each."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from cli_stand_ins import GOOD_ARM
from hypothesis import given
from hypothesis import strategies as st
from recording_files import GOOD, save

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.joining import Part, join
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.inputs import read_recordings

STARTED = 1_700_000_000.0
MAP: dict[str, Any] = {
    "time": {"column": "t", "unit": "s"},
    "current": {"file": "*_current.csv", "column": "i", "unit": "mA"},
    "arm_angle": {"file": "*_angle.csv", "column": "phi", "unit": "deg", "sign": -1},
}


def table_file(path: Path, name: str, values: Any, times: Any = None) -> None:
    times = STARTED + np.arange(len(values)) / 4 if times is None else times
    path.write_text(
        f"t,{name}\n"
        + "".join(f"{time!r},{value!r}\n" for time, value in zip(map(float, times), map(float, values), strict=True))
    )


@pytest.fixture
def runs(tmp_path: Path) -> Path:
    folder = tmp_path / "runs"
    folder.mkdir()
    for number, run in enumerate(("one", "two")):
        table_file(folder / f"{run}_current.csv", "i", 1000.0 * number + np.arange(4))
        table_file(folder / f"{run}_angle.csv", "phi", 90.0 * np.arange(4))
    return folder


def test_a_folder_of_files_of_one_signal_each(runs: Path) -> None:
    one, two = Recording.read_all(runs, MAP)
    assert (one.name, two.name) == ("one", "two")
    assert one.time.tolist() == [0, 0.25, 0.5, 0.75]
    assert two.command.tolist() == pytest.approx([1, 1.001, 1.002, 1.003])
    assert np.allclose(two.signals["arm_angle"], -np.pi / 2 * np.arange(4))
    assert two.source == str(runs / "two_current.csv")
    assert two.sha256 != Recording.read(runs / "one_current.csv", MAP).sha256


def test_any_of_its_files_names_a_recording(runs: Path) -> None:
    for names in (["two_angle.csv"], ["two_current.csv"], ["two_angle.csv", "two_current.csv"]):
        (found,) = Recording.read_all([runs / name for name in names], MAP)
        assert found.name == "two"
        assert found.command[0] == 1.0


def test_files_of_one_name_in_folders_of_runs(tmp_path: Path) -> None:
    table = {**MAP, "current": {**MAP["current"], "file": "current.csv"}, "arm_angle": {**MAP["arm_angle"], "file": "angle.csv"}}
    for run in ("a", "b"):
        (tmp_path / run).mkdir()
        table_file(tmp_path / run / "current.csv", "i", np.arange(3))
        table_file(tmp_path / run / "angle.csv", "phi", np.arange(3))
    assert [found.name for found in Recording.read_all([tmp_path / "a", tmp_path / "b"], table)] == ["a", "b"]


def test_one_signal_beside_a_file_with_the_others(tmp_path: Path) -> None:
    table = {
        "time": {"column": "t", "unit": "s"},
        "current": {"column": "i", "unit": "A"},
        "arm_angle": {"column": "phi", "unit": "rad"},
        "tip_deflection": {"file": "*.camera.mat", "variable": "tip", "unit": "mm", "time": {"variable": "clock", "unit": "ms"}},
    }
    times = STARTED + np.arange(4) / 4
    (tmp_path / "run1.csv").write_text("t,i,phi\n" + "".join(f"{float(time)!r},1,2\n" for time in times))
    scipy.io.savemat(tmp_path / "run1.camera.mat", {"clock": 1000 * times, "tip": np.arange(4.0)})
    for paths in (tmp_path, [tmp_path / "run1.csv"], [tmp_path / "run1.camera.mat"]):
        (found,) = Recording.read_all(paths, table)
        assert found.name == "run1"
        assert np.allclose(found.signals["tip_deflection"], [0, 0.001, 0.002, 0.003])
        assert found.signals["arm_angle"].tolist() == [2, 2, 2, 2]


def test_a_slower_sensor_is_absent_between_its_readings(runs: Path) -> None:
    table_file(runs / "one_angle.csv", "phi", [90.0, 180.0], STARTED + np.array([0.1, 0.5]))
    (found,) = Recording.read_all(runs / "one_angle.csv", MAP)
    assert np.allclose(found.time, [0, 0.1, 0.25, 0.5, 0.75], rtol=0, atol=1e-6)
    assert found.command.tolist() == [0, 0, 0.001, 0.002, 0.003]
    assert np.allclose(found.signals["arm_angle"], [np.nan, -np.pi / 2, np.nan, -np.pi, np.nan], equal_nan=True)
    found.write(runs / "again.csv")
    again = Recording.read(runs / "again.csv")
    assert np.array_equal(again.signals["arm_angle"], found.signals["arm_angle"], equal_nan=True)


def test_corrections_hold_on_the_times_of_their_own_file(runs: Path) -> None:
    table_file(runs / "one_angle.csv", "phi", [1, 1, 2, 2, 3, 3], STARTED + 0.2 + 0.1 * np.arange(6))
    angle = {**MAP["arm_angle"], "unit": "rad", "sign": 1, "repeats": 2, "shift": "0.1 s", "ignore": [[0.55, 0.65]]}
    (found,) = Recording.read_all(runs / "one_angle.csv", {**MAP, "arm_angle": angle})
    measured = ~np.isnan(found.signals["arm_angle"])
    assert found.signals["arm_angle"][measured].tolist() == [1, 2]
    assert np.allclose(found.time[measured], [0.1, 0.3], rtol=0, atol=1e-6)
    assert found.notes == (f"'arm_angle' was measured in 2 of {len(found)} rows",)


def test_conditions_of_its_files_must_agree(runs: Path) -> None:
    for name, mass in (("one_current.csv", 0.3), ("one_angle.csv", 0.3)):
        (runs / name).write_text(f"# payload = {mass} kg\n" + (runs / name).read_text())
    assert Recording.read(runs / "one_current.csv", MAP).conditions == {"payload": 0.3}
    (runs / "one_angle.csv").write_text((runs / "one_angle.csv").read_text().replace("0.3 kg", "0.4 kg"))
    assert "one_angle.csv: condition 'payload' is 0.4, but 0.3 in another of its files" in failure(runs / "one_current.csv")


def test_the_map_of_an_arm_may_name_files(runs: Path) -> None:
    arm_file = runs.parent / "A.toml"
    arm_file.write_text(
        GOOD_ARM + '\n[columns]\ntime = { column = "t", unit = "s" }\n'
        'current = { file = "*_current.csv", column = "i", unit = "A" }\n'
        'arm_angle = { file = "*_angle.csv", column = "phi", unit = "rad" }\n'
    )
    arm = Arm.load(arm_file)
    assert [found.name for found in read_recordings(arm, [runs], None)] == ["one", "two"]
    own = save(runs.parent, GOOD, "simulated.csv")  # as `flexarm simulate` writes it
    one, simulated = (found for found in read_recordings(arm, [own, runs / "one_angle.csv"], None)[::-1])
    assert (one.name, simulated.name) == ("one", "simulated")
    assert simulated.notes == ("read by its own header; the arm's [columns] are of several files",)
    assert [found.name for found in read_recordings(arm, [own], None)] == ["simulated"]
    with pytest.raises(InputError, match="is none of the files"):
        read_recordings(arm, [save(runs.parent, "t,i,q\n0,1,2\n1,2,3\n", "other.csv")], None)


def failure(*paths: Path, table: dict[str, Any] = MAP) -> str:
    with pytest.raises(InputError) as caught:
        Recording.read_all(paths, table)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    return message


def test_files_that_do_not_fit_together(runs: Path) -> None:
    current, angle = runs / "one_current.csv", runs / "one_angle.csv"
    assert "is none of the files that [columns] names, '*_current.csv', '*_angle.csv'" in failure(runs.parent / "other.csv")
    assert "has no file '*_current.csv'" in failure(runs.parent)
    table_file(angle, "phi", [1, 2, 3], [0, 1, 2])
    message = failure(current)
    assert message.startswith(f"{current}: 'arm_angle' is measured from -1.7e+09 to -1.7e+09 s, the command from 0 to 0.75 s")
    assert "one clock" in message
    table_file(angle, "phi", [1, 2, 3], STARTED + np.array([0, 0.25, 0.25]))
    assert "the time of 'arm_angle' does not rise after its sample 2" in failure(current)
    angle.write_text("t,phi\n0,1\n1,oops\n")
    assert "one_angle.csv: row 3, column 'arm_angle': 'oops'" in failure(current)
    angle.unlink()
    assert "one_angle.csv: cannot be read: No such file" in failure(current)


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ({"file": "*_*.csv"}, "with one \\* for the run"),
        ({"file": "../*.csv"}, "without folders"),
        ({"file": ""}, "without folders"),
        ({"file": 3}, "write a text"),
        ({"time": {"column": "t", "unit": "s"}}, "no 'file' of its own"),
        ({"file": "*_a.csv", "time": {"column": "t"}}, "no unit"),
        ({"file": "*_a.csv", "time": {"column": "t", "unit": "s", "file": "x"}}, "unknown key 'file'"),
    ],
)
def test_maps_of_files_are_checked(entry: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        load_columns({**MAP, "arm_angle": {"column": "phi", "unit": "deg", **entry}})
    with pytest.raises(InputError, match="no place in it"):
        load_columns({**MAP, "arm_angle": {"file": "*_a.csv", "unit": "deg"}})


def test_a_reference_that_begins_later(runs: Path) -> None:
    table = {**MAP, "reference": {"file": "*_goal.csv", "column": "goal", "unit": "rad"}}
    table_file(runs / "one_goal.csv", "goal", [1.0, 2.0], STARTED + np.array([0.25, 0.5]))
    recording = Recording.read(runs / "one_current.csv", table)
    assert recording.reference is not None
    assert recording.reference.tolist() == [1, 2, 2]
    assert recording.command.tolist() == [0.001, 0.002, 0.003]
    table_file(runs / "one_goal.csv", "goal", [1.0, 2.0], STARTED + np.array([0.75, 0.8]))
    assert "fewer than two commands after the first reference" in failure(runs / "one_current.csv", table=table)


steps = st.lists(st.floats(0.01, 1.0), min_size=2, max_size=12)


@given(steps, steps, st.floats(-1.0, 1.0))
def test_no_reading_is_moved_repeated_or_made_up(command_steps: list[float], signal_steps: list[float], start: float) -> None:
    command = np.cumsum(command_steps)
    times = command[0] + start + np.cumsum(signal_steps)
    values = np.arange(1.0, len(times) + 1)
    parts = [Part(command, {"current": np.arange(len(command)) + 0.5}), Part(times, {"arm_angle": values})]
    near = 0.01 * min(np.median(np.diff(command)), np.median(np.diff(times)))
    inside = (times >= command[0] - near) & (times <= command[-1] + near)
    if not inside.any():
        with pytest.raises(InputError, match="one clock"):
            join(parts)
        return
    found = join(parts)
    assert np.all(np.diff(found["time"]) > 0)
    assert np.isin(command, found["time"]).all()
    measured = ~np.isnan(found["arm_angle"])
    kept = found["arm_angle"][measured].astype(int) - 1
    assert set(kept) <= set(np.flatnonzero(inside))
    assert np.all(np.abs(found["time"][measured] - times[kept]) <= near)
    if np.min(np.diff(np.sort(np.concatenate([command, times])))) > 2 * near:  # no two are of one time
        assert kept.tolist() == np.flatnonzero(inside).tolist()
    held = np.searchsorted(command, found["time"] + near, side="right") - 1
    assert np.array_equal(found["current"], held + 0.5)
