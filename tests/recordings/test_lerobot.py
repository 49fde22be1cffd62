"""Data sets of LeRobot: episodes as recordings, elements by name, times by the stated rate."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import GOOD, refusal, save

from flexarm_env import Arm, InputError, Recording
from flexarm_env.lab.uploads import read_upload
from flexarm_env.terminal.inputs import read_recordings

RATE, LONG, JOINTS = 500, 20_000, ["shoulder.pos", "elbow.pos"]
MAP: dict[str, Any] = {
    "time": {"column": "timestamp", "unit": "s"},
    "current": {"column": "action[1]", "unit": "A"},
    "arm_angle": {"column": "observation.state[elbow.pos]", "unit": "deg"},
}
FEATURES = {
    "observation.state": {"dtype": "float32", "shape": [2], "names": JOINTS},
    "action": {"dtype": "float32", "shape": [2], "names": {"motors": JOINTS}},
    "timestamp": {"dtype": "float32", "shape": [1], "names": None},
}


def rows(episodes: dict[int, int]) -> dict[str, Any]:
    """Columns of some episodes of so many rows; readings are the row in the file."""
    arrow = pytest.importorskip("pyarrow")
    frames = np.concatenate([np.arange(count) for count in episodes.values()])
    count = np.arange(len(frames), dtype=np.float32)
    return {
        "observation.state": arrow.array(np.stack([-count, count], axis=1).tolist(), arrow.list_(arrow.float32(), 2)),
        "action": arrow.array(np.stack([0 * count, frames], axis=1).tolist()),
        "timestamp": (frames / RATE).astype(np.float32),
        "frame_index": frames,
        "episode_index": np.repeat(list(episodes), list(episodes.values())),
    }


def dataset(folder: Path, files: dict[str, dict[int, int]], info: Any = None) -> Path:
    """A data set of some files, each with episodes of so many rows."""
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    (folder / "data/chunk-000").mkdir(parents=True)
    (folder / "meta/episodes").mkdir(parents=True)
    for name, episodes in files.items():
        parquet.write_table(arrow.table(rows(episodes)), folder / "data/chunk-000" / name)
    text = info if isinstance(info, str) else json.dumps(info or {"fps": RATE, "features": FEATURES})
    (folder / "meta/info.json").write_text(text)
    return folder


def test_episodes_of_one_file_are_as_many_recordings(tmp_path: Path) -> None:
    folder = dataset(tmp_path / "v3", {"file-000.parquet": {0: 5, 1: 4}, "file-001.parquet": {2: 6}})
    found = Recording.read_all(folder, MAP)
    assert [one.name for one in found] == ["file-000 episode 0", "file-000 episode 1", "file-001"]
    assert [len(one) for one in found] == [5, 4, 6]
    for one, first in zip(found, (0, 5, 0), strict=True):
        assert one.command.tolist() == list(range(len(one)))
        assert np.allclose(one.signals["arm_angle"], np.radians(first + np.arange(len(one))))
        assert np.allclose(one.time, np.arange(len(one)) / RATE, rtol=0, atol=1e-12)


def test_episodes_are_picked_by_their_number(tmp_path: Path) -> None:
    """One to a file, as in version 2, or several, as in version 3."""
    v2 = dataset(tmp_path / "v2", {f"episode_00000{k}.parquet": {k: 4 + k} for k in range(3)})
    v3 = dataset(tmp_path / "v3", {"file-000.parquet": {k: 4 + k for k in range(3)}})
    for folder in (v2, v3):
        assert [len(one) for one in Recording.read_all(folder, {**MAP, "episode_index": [0, 2]})] == [4, 6]
        assert [len(one) for one in Recording.read_all(folder, {**MAP, "episode_index": 1})] == [5]
        with pytest.raises(InputError, match=r"has 1 of the episodes that episode_index in \[columns\] names \(1, 7\)"):
            Recording.read_all(folder, {**MAP, "episode_index": [1, 7]})
    file = v3 / "data/chunk-000/file-000.parquet"
    assert len(Recording.read(file, {**MAP, "episode_index": 2})) == 6
    assert "has 3 episodes, which are as many recordings; name one by episode_index" in refusal(file, columns=MAP)
    assert "has 0 of the episodes that episode_index in [columns] names (3)" in refusal(file, columns={**MAP, "episode_index": 3})
    for wrong in (-1, True, "1", [1, 1], [0.5]):
        with pytest.raises(InputError, match="episode_index: is"):
            Recording.read(file, {**MAP, "episode_index": wrong})


def test_an_episode_of_a_file_without_episodes_is_refused(tmp_path: Path) -> None:
    message = refusal(save(tmp_path, GOOD), columns={"arm_angle": {"sign": -1}, "episode_index": 7})
    assert message == "has no episodes, but [columns] names some by episode_index; leave it out"
    joined = {
        name: {"file": f"*_{name}.csv", "column": "x", "unit": unit} for name, unit in (("current", "A"), ("arm_angle", "rad"))
    }
    with pytest.raises(InputError, match="has episode_index, which is of one file of episodes, and 'file'"):
        Recording.read_all(tmp_path, {"time": {"column": "t", "unit": "s"}, **joined, "episode_index": 7})


def test_an_arms_own_map_and_an_upload_read_episodes(tmp_path: Path) -> None:
    folder = dataset(tmp_path / "set", {"file-000.parquet": {0: 60, 3: 70}})
    text = 'time = { column = "timestamp", unit = "s" }\ncurrent = { column = "action[1]", unit = "A" }\n'
    columns = text + 'arm_angle = { column = "observation.state[1]", unit = "rad" }\n'
    (tmp_path / "map.toml").write_text(f"[columns]\n{columns}")
    arm = Arm.load("thesis")
    arm.save(tmp_path / "arm.toml")
    with (tmp_path / "arm.toml").open("a") as file:
        file.write(f"\n[columns]\n{columns}")
    found = read_recordings(Arm.load(tmp_path / "arm.toml"), [folder], None)
    assert [len(one) for one in found] == [60, 70]
    content = (folder / "data/chunk-000/file-000.parquet").read_bytes()
    sent = read_upload(arm, "file-000.parquet", content, tmp_path / "map.toml", [])
    assert [one.name for one in sent] == [one.name for one in found]
    with pytest.raises(InputError, match="is here already"):
        read_upload(arm, "file-000.parquet", content, tmp_path / "map.toml", sent)


def test_stamps_of_single_precision_count_frames_at_the_stated_rate(tmp_path: Path) -> None:
    """After 40 s they are rounded by a 500th of a step: uneven sampling, which the machine never had."""
    folder = dataset(tmp_path / "set", {"episode_000000.parquet": {0: LONG}})
    (found,) = Recording.read_all(folder, MAP)
    assert np.ptp(np.diff(found.time)) < 1e-12
    (folder / "meta/info.json").write_text(json.dumps({"fps": 30, "features": FEATURES}))
    message = refusal(folder / "data/chunk-000/episode_000000.parquet", columns=MAP)
    assert "timestamp goes on by 0.002 s a row, but meta/info.json states 30 frames per second" in message
    rate = {**MAP, "time": {"rate": RATE}}
    assert np.ptp(np.diff(Recording.read(folder / "data/chunk-000/episode_000000.parquet", rate).time)) < 1e-12


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ("observation.state[elbo.pos]", "'observation.state' has no 'elbo.pos' in meta/info.json; did you mean 'elbow.pos'?"),
        ("observation.stat[elbow.pos]", "no feature 'observation.stat' in meta/info.json; did you mean 'observation.state'?"),
        ("timestamp[elbow.pos]", "meta/info.json names no elements of 'timestamp'; write a number, counted from 0"),
        ("observation.state[2]", "have 2 elements, no [2]"),
    ],
)
def test_names_that_lead_nowhere(tmp_path: Path, place: str, words: str) -> None:
    folder = dataset(tmp_path / "set", {"episode_000000.parquet": {0: 8}})
    table = {**MAP, "arm_angle": {"column": place, "unit": "rad"}}
    assert words in refusal(folder / "data/chunk-000/episode_000000.parquet", columns=table)


def test_names_need_their_info(tmp_path: Path) -> None:
    folder = dataset(tmp_path / "set", {"episode_000000.parquet": {0: 8}})
    lone = tmp_path / "lone.parquet"
    lone.write_bytes((folder / "data/chunk-000/episode_000000.parquet").read_bytes())
    assert "no meta/info.json beside the data states names" in refusal(lone, columns=MAP)
    numbered = {**MAP, "arm_angle": {"column": "observation.state[1]", "unit": "rad"}}
    assert len(Recording.read(lone, numbered)) == 8


@pytest.mark.parametrize(
    ("info", "words"),
    [
        ("{", "meta/info.json beside it is damaged or no JSON"),
        ("[1]", "meta/info.json beside it has no table of features"),
        ('{"fps": "fast"}', "meta/info.json: fps is 'fast'"),
        ('{"fps": 1e999}', "meta/info.json: fps is 'inf'"),
        ("[" * 100_000, "meta/info.json beside it is damaged or no JSON"),
    ],
)
def test_a_damaged_info_is_named(tmp_path: Path, info: str, words: str) -> None:
    folder = dataset(tmp_path / "set", {"episode_000000.parquet": {0: 8}}, info)
    assert words in refusal(folder / "data/chunk-000/episode_000000.parquet", columns=MAP)


def test_rows_of_an_episode_that_are_not_together_are_named(tmp_path: Path) -> None:
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    columns = rows({0: 4, 1: 4})
    table = {**MAP, "arm_angle": {"column": "observation.state[1]", "unit": "rad"}}
    for numbers, words in (
        ([0, 0, 1, 1, 0, 0, 1, 1], "row 5: episode 0 begins again, which began in row 1"),
        ([0, 0, 0, 0, 0, 0, 0, 1], "row 8: episode 1 has one row"),
        ([0.5] * 8, "column 'episode_index': is 'double' with 0 empty rows, no whole numbers"),
    ):
        parquet.write_table(arrow.table({**columns, "episode_index": numbers}), tmp_path / "run.parquet")
        assert words in refusal(tmp_path / "run.parquet", columns=table)


def test_a_fault_has_its_row_in_the_file(tmp_path: Path) -> None:
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    columns = rows({0: 4, 1: 4})
    columns["timestamp"][6] = columns["timestamp"][5]
    parquet.write_table(arrow.table(columns), tmp_path / "run.parquet")
    table = {**MAP, "arm_angle": {"column": "observation.state[1]", "unit": "rad"}}
    with pytest.raises(InputError, match="row 7, column 'time'"):
        Recording.read_all(tmp_path / "run.parquet", table)
