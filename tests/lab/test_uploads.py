"""Uploads are read as files on disk are, and no more of them than can be held."""

from __future__ import annotations

import errno
import os

import numpy as np
import pytest

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.simulate import simulate
from flexarm_env.lab import uploads
from flexarm_env.lab.uploads import plain_name, read_upload


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis")


@pytest.fixture(scope="module")
def content(arm, tmp_path_factory) -> bytes:
    path = tmp_path_factory.mktemp("upload") / "run.csv"
    simulate(arm, "pulse", duration=0.5, rate=200.0).write(path)
    return path.read_bytes()


def test_an_upload_is_read_like_a_file(arm, content):
    (found,) = read_upload(arm, "C:\\data\\run 1.csv", content, None, [])
    assert found.name == "run 1"
    assert found.source == "run 1.csv"
    expected = simulate(arm, "pulse", duration=0.5, rate=200.0)
    assert np.array_equal(found.signals["strain_mid"], expected.signals["strain_mid"])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "bad.csv: is empty"),
        (b"\x00\x01\x02", "bad.csv: is a binary file"),
        (b"time [s],current [A],arm_angle [rad]\n0,1,0\n1,x,0\n", "bad.csv: row 3, column 'current': 'x' is not a number"),
        (b"time [s],current [furlong],arm_angle [rad]\n0,1,0\n1,1,0\n", "furlong"),
        (b"time [s],voltage [V],arm_angle [rad]\n0,1,0\n1,1,0\n", "holds voltage"),
    ],
)
def test_a_bad_upload_gets_the_reader_s_own_line(arm, content, words):
    with pytest.raises(InputError) as caught:
        read_upload(arm, "bad.csv", content, None, [])
    line = str(caught.value)
    assert words in line
    assert line.startswith("bad.csv: ")
    assert "flexarm-lab-" not in line
    assert len(line.splitlines()) == 1


def test_uploads_are_bounded(arm, content, monkeypatch):
    (one,) = read_upload(arm, "run.csv", content, None, [])
    with pytest.raises(InputError, match="'run' is here already"):
        read_upload(arm, "run.csv", content, None, [one])
    with pytest.raises(InputError, match="12 recordings are here already"):
        read_upload(arm, "more.csv", content, None, [one] * 12)
    monkeypatch.setattr(uploads, "MOST_SAMPLES", 150)
    with pytest.raises(InputError, match="more than 150 samples"):
        read_upload(arm, "more.csv", content, None, [one])
    monkeypatch.setattr(uploads, "LARGEST_BODY", 100)
    with pytest.raises(InputError, match="larger than"):
        read_upload(arm, "more.csv", content, None, [])


@pytest.mark.parametrize("name", ["\U00020000" * 76 + ".csv", "ä" * 300 + ".csv"])
def test_a_name_longer_than_any_file_s_is_cut_in_bytes(arm, content, name):
    (found,) = read_upload(arm, name, content, None, [])
    assert found.source == plain_name(name)


def test_an_upload_that_cannot_be_written_is_one_line(arm, content, monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "gone"))
    with pytest.raises(
        InputError, match=r"^run\.csv: no temporary file can be written: No such file .*; make room, or set TMPDIR$"
    ):
        read_upload(arm, "run.csv", content, None, [])

    def full(path, content):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr("pathlib.Path.write_bytes", full)
    with pytest.raises(InputError, match=r"^run\.csv: no temporary file can be written: No space left"):
        read_upload(arm, "run.csv", content, None, [])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "plain"),
    [
        ("../../etc/passwd", "passwd"),
        ("..", "recording.csv"),
        ("", "recording.csv"),
        ("a\nb<script>.csv", "a_b_script_.csv"),
        ("x" * 300 + ".csv", "x" * 76 + ".csv"),
        ("\U00020000" * 76 + ".csv", "\U00020000" * 62 + ".csv"),
    ],
)
def test_names_are_those_of_files(name, plain):
    assert plain_name(name) == plain
