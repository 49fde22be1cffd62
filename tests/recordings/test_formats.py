"""A format is one file in formats/: commands, folders and the lab follow."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from cli_stand_ins import GOOD_ARM, Call, fake_compare
from recording_files import EMPS, GOOD, LOGGER, refusal, same, save

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.lab.uploads import read_upload
from flexarm_env.recordings import formats
from flexarm_env.recordings.formats import catalogue
from flexarm_env.recordings.recording import Recording
from flexarm_env.recordings.table import MOST_LINES

NPZ = '''
"""NumPy archives with an array for each column."""

import io

import numpy as np

from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.table import Table


def read(content, columns):
    arrays = np.load(io.BytesIO(content))
    return Table({name: arrays[source.place] for name, source in columns.sources.items()}, dict(columns.sources))


FORMAT = Format("NumPy archive", (".npz",), ("variable",), read)
'''

MAP = """
[columns]
time = { variable = "t", unit = "s" }
current = { variable = "i", unit = "mA" }
arm_angle = { variable = "phi", unit = "deg" }
"""


@pytest.fixture
def npz(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with two recordings of a format that has been dropped in, and the arm file that maps them."""
    place = tmp_path / "formats"
    place.mkdir()
    (place / "numpy_archive.py").write_text(NPZ)
    monkeypatch.setattr(formats, "__path__", [*formats.__path__, str(place)])
    catalogue.formats.cache_clear()
    folder = tmp_path / "runs"
    folder.mkdir()
    for name in ("one", "two"):
        np.savez(folder / f"{name}.npz", t=np.arange(60) / 10, i=np.ones(60), phi=np.arange(60))
    (tmp_path / "A.toml").write_text(GOOD_ARM + MAP)
    yield folder
    monkeypatch.undo()
    catalogue.formats.cache_clear()


def test_a_file_and_a_folder_of_a_new_format_are_read(capsys, monkeypatch, npz):
    arm, flexarm, read = npz.parent / "A.toml", Call(capsys), []
    monkeypatch.setitem(vars(flexarm_env), "compare", lambda arm, runs, **_: read.append(runs) or fake_compare(arm, runs))
    assert flexarm("compare", npz, "--arm", arm) == 0, flexarm.err
    assert flexarm("compare", npz / "two.npz", npz / "one.npz", "--arm", arm) == 0
    (first, second), (third, _) = read
    assert [first.name, second.name, third.name] == ["one", "two", "two"]
    assert same(first, third)
    assert first.command[0] == pytest.approx(0.001)
    assert first.signals["arm_angle"][9] == pytest.approx(np.pi / 20)


def test_its_faults_are_those_of_any_other(npz):
    file, arm = npz / "one.npz", npz.parent / "A.toml"
    assert refusal(file) == "a NumPy archive needs a [columns] table that names its columns by 'variable'"
    assert "[columns] has 'column' for 'time'; use 'variable'" in refusal(file, columns=LOGGER)
    for bad, words in (
        (np.ones((60, 2)), "'arm_angle' is no vector"),
        (np.full(60, np.nan), "column 'arm_angle': has no reading in any row"),
        (np.full(60, np.inf), "sample 1, column 'arm_angle': is inf"),
        (np.ones(59), "lengths differ"),
        (np.zeros(0), "without samples"),
        (np.full(60, "x"), "'arm_angle' is no vector"),
    ):
        np.savez(file, t=np.arange(60), i=np.ones(60), phi=bad)
        assert words in refusal(file, columns=arm)


def test_the_lab_and_the_messages_follow(npz, tmp_path):
    arm = Arm.load(npz.parent / "A.toml")
    (found,) = read_upload(arm, "two.npz", (npz / "two.npz").read_bytes(), None, [])
    assert (found.source, len(found)) == ("two.npz", 60)
    assert catalogue.suffixes() == [".csv", ".dat", ".db3", ".json", ".lvm", ".mat", ".mcap", ".npz", ".parquet", ".txt"]
    (tmp_path / "none").mkdir()
    with pytest.raises(InputError, match=r"a folder without CSV files or other recordings \(.*\.mat, .*\.npz, \.parquet\)"):
        Recording.read_all(tmp_path / "none")


def test_formats_are_those_of_the_folder():
    assert [one.name for one in catalogue.formats()] == [
        "JSON log",
        "LabVIEW measurement file",
        "MATLAB file",
        "MCAP file",
        "Parquet file",
        "ROS 2 bag",
        "text table",
    ]
    assert catalogue.folder_suffixes() == [".csv", ".db3", ".lvm", ".mat", ".mcap", ".parquet"]
    assert catalogue.format_of(Path("run.MAT")).name == "MATLAB file"
    assert {catalogue.format_of(Path(name)).name for name in ("a.csv", "a.TXT", "a.xlsx", "a", "a.log")} == {"text table"}


def test_a_folder_of_matlab_files(tmp_path):
    columns = {"t": np.arange(4.0), "vir": np.ones(4), "qm": np.arange(4), "qg": np.zeros(4)}
    for name in ("b", "a"):
        scipy.io.savemat(tmp_path / f"{name}.mat", columns)
    assert [one.name for one in Recording.read_all(tmp_path, EMPS)] == ["a", "b"]


def test_one_recording_in_two_formats_is_not_counted_twice(tmp_path):
    content = io.BytesIO()
    scipy.io.savemat(content, {"t": np.arange(4.0)})
    save(tmp_path, content.getvalue(), "run.mat")
    save(tmp_path, GOOD)
    save(tmp_path, GOOD, "run.d.csv")
    with pytest.raises(InputError, match=r"run\.csv and run\.mat, which may be one recording in two formats"):
        Recording.read_all(tmp_path)


def test_more_lines_than_can_be_held_are_refused_at_once(tmp_path):
    for end in ("\n", "\r\n", "\r"):
        path = save(tmp_path, GOOD + f"1{end}" * (MOST_LINES + 1))
        assert f"the limit is {MOST_LINES}" in refusal(path)
