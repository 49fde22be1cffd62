"""Files that FlexArm writes are whole or not there, whatever happens meanwhile."""

from __future__ import annotations

import errno
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import flexarm_env
from flexarm_env.errors import InputError
from flexarm_env.files import write_whole

#: Long enough that a write takes several blocks.
SIZE = 400_000
WRITER = """
import sys
from pathlib import Path
from flexarm_env.files import write_whole

place, letter = Path(sys.argv[1]), sys.argv[2]
while True:
    write_whole(place, letter * 400_000)
"""


def writer(place: Path, letter: str) -> subprocess.Popen[bytes]:
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1])}
    return subprocess.Popen([sys.executable, "-c", WRITER, str(place), letter], env=environment)


def wait_for(place: Path) -> None:
    until = time.monotonic() + 60.0
    while not place.exists():
        assert time.monotonic() < until
        time.sleep(0.01)


def test_a_file_of_two_writers_is_that_of_one(tmp_path):
    place = tmp_path / "result.json"
    writers = [writer(place, letter) for letter in "ab"]
    try:
        wait_for(place)
        seen = set()
        for _ in range(100):
            content = place.read_text()
            assert content in ("a" * SIZE, "b" * SIZE)
            seen.add(content[0])
            time.sleep(0.005)
    finally:
        for process in writers:
            process.kill()
            process.wait()
    assert seen == {"a", "b"}, "only one of the two wrote at all"


def test_a_killed_writer_leaves_the_file_whole(tmp_path):
    place, draw = tmp_path / "result.json", random.Random(3)
    write_whole(place, "z" * SIZE)
    for letter in "abcd":
        process = writer(place, letter)
        until = time.monotonic() + 60.0
        while place.read_text()[0] != letter and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(draw.uniform(0.0, 0.05))
        process.send_signal(signal.SIGKILL)
        process.wait()
        assert place.read_text() == letter * SIZE


@pytest.mark.parametrize("failure", ["fsync", "replace"])
@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO])
def test_a_write_that_fails_leaves_the_old_file_and_no_draft(tmp_path, monkeypatch, failure, number):
    def fail(*arguments):
        raise OSError(number, os.strerror(number))

    place = tmp_path / "result.json"
    write_whole(place, "old")
    monkeypatch.setattr(os, failure, fail)
    with pytest.raises(InputError, match=r"cannot write .*result\.json: .*; name a folder that exists and can be written"):
        write_whole(place, "new")
    assert [path.name for path in tmp_path.iterdir()] == ["result.json"]
    assert place.read_text() == "old"


@pytest.mark.parametrize("name", ["", "/", "a file/result.json", "no folder/result.json", "a folder", "x" * 300])
def test_a_place_that_cannot_be_written_is_one_line(tmp_path, name):
    (tmp_path / "a file").write_text("")
    (tmp_path / "a folder").mkdir()
    with pytest.raises(InputError, match="cannot write") as caught:
        write_whole(tmp_path / name if name else Path(), "new")
    assert str(caught.value).isprintable()
