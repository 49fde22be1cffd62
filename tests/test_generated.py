"""Generated modules: one for one text, whoever asks at once, and made anew where their files are damaged."""

from __future__ import annotations

import errno
import io
import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import flexarm_env
from flexarm_env import cache
from flexarm_env.generated import generated_module

SOURCE = """
import time
from collections import namedtuple

time.sleep(0.05)
Bundle = namedtuple("Bundle", "value")
"""
#: One kernel that is compiled when the module is imported, and one at its first call.
KERNELS = """
from numba import int64, njit


@njit((int64,), cache=True)
def double(x):
    return 2 * x


@njit(cache=True)
def triple(x):
    return 3 * x
"""
#: Limits the size of files, as a quota does, where "LARGEST" is set.
PROGRAM = f"""
import os, resource
largest = int(os.environ.get("LARGEST", "-1"))
resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
from flexarm_env.generated import generated_module
notice = lambda: print("compiling")
module = generated_module("flexarm_try", "kernels", lambda: {KERNELS!r}, notice)
print(module.double(21), module.triple(14))
"""


def test_threads_that_need_a_module_at_once_get_one(tmp_path, monkeypatch):
    monkeypatch.setenv("FLEXARM_CACHE", str(tmp_path))
    with ThreadPoolExecutor(8) as threads:
        found = list(threads.map(lambda _: generated_module("flexarm_try", SOURCE, lambda: SOURCE), range(8)))
    assert len({id(module.Bundle) for module in found}) == 1
    assert sorted(path.suffix for path in tmp_path.glob("flexarm_try*")) == [".py", ".sha256"]


def run(folder: Path | str, **changes: str) -> subprocess.CompletedProcess[str]:
    path = str(Path(flexarm_env.__file__).parents[1])
    environment = os.environ | {"PYTHONPATH": path, "FLEXARM_CACHE": str(folder)} | changes
    return subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True, env=environment)


def damaged(content: bytes, draw: random.Random) -> bytes:
    place = draw.randrange(len(content))
    flipped = content[:place] + bytes([content[place] ^ 1 << draw.randrange(8)]) + content[place + 1 :]
    return draw.choice([b"", content[:place], flipped, draw.randbytes(len(content)), b"text\n"])


def test_a_damaged_cache_is_made_anew(tmp_path):
    assert run(tmp_path).stdout == "compiling\n42 42\n"
    assert run(tmp_path).stdout == "42 42\n"
    draw = random.Random(11)
    files = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    assert {path.suffix for path in files} - {".pyc"} == {".py", ".sha256", ".nbi", ".nbc"}
    for path in {path.suffix: path for path in files}.values():
        path.write_bytes(damaged(path.read_bytes(), draw))
        made = run(tmp_path)
        assert made.stdout.endswith("42 42\n"), (path, made.stderr)
        assert made.stderr == ""
    assert run(tmp_path).stdout == "42 42\n"


@pytest.mark.parametrize("seed", range(20))
def test_a_file_that_is_not_as_it_was_written_is_removed(tmp_path, seed):
    draw, files = random.Random(seed), ["m.py", *(f"__pycache__/{name}" for name in ("m.pyc", "m.f-1.1.nbc", "m.f-1.nbi"))]
    (tmp_path / "__pycache__").mkdir()
    for file in (*files, "__pycache__/other.nbc"):
        (tmp_path / file).write_bytes(draw.randbytes(99))
    cache.record(tmp_path, "m")
    cache.remove_damaged(tmp_path, "m")
    assert all((tmp_path / file).exists() for file in files)
    victim = tmp_path / draw.choice(files)
    victim.write_bytes(damaged(victim.read_bytes(), draw))
    cache.remove_damaged(tmp_path, "m")
    assert [file for file in files if not (tmp_path / file).exists()] == [str(victim.relative_to(tmp_path))]
    (tmp_path / "m.sha256").write_bytes(b"\xff")
    cache.remove_damaged(tmp_path, "m")
    assert [path.name for path in tmp_path.rglob("*") if path.is_file()] == ["other.nbc"]


@pytest.mark.parametrize("home", ["", "a file"])
def test_a_cache_that_cannot_be_written_is_replaced_for_the_run(tmp_path, home):
    (tmp_path / "file").write_text("")
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    changes = {"HOME": str(tmp_path / "file"), "XDG_CACHE_HOME": "", "TMPDIR": str(temporary)}
    made = run("" if home == "" else tmp_path / "file" / "cache", **changes)
    assert made.stdout == "compiling\n42 42\n"
    assert "cannot be written" in made.stderr
    assert "set FLEXARM_CACHE to a folder that can be written" in made.stderr
    assert list(temporary.iterdir()) == [], "the temporary cache was left behind"


def test_a_cache_without_room_is_replaced_for_the_run(tmp_path, monkeypatch, caplog):
    wanted, temporary = tmp_path / "small", tmp_path / "temporary"
    temporary.mkdir()

    class Small(io.FileIO):
        """A file on a disk with room for 1 MB."""

        def write(self, content):
            if self.tell() + len(content) > 2**20:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return super().write(content)

    whole = tempfile.TemporaryFile

    def on_disk(dir, **arguments):
        return Small(dir / "probe", "wb") if dir == wanted else whole(dir=dir, **arguments)

    monkeypatch.setenv("FLEXARM_CACHE", str(wanted))
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    monkeypatch.setattr(tempfile, "TemporaryFile", on_disk)
    module = generated_module("flexarm_small", KERNELS, lambda: KERNELS)
    assert module.double(21) == 42
    assert temporary in Path(module.__file__).parents
    assert f"{wanted} has no room for 32 MB of compiled kernels: what is compiled is lost" in caplog.text
    assert "set FLEXARM_CACHE to a folder that can be written, with room" in caplog.text


def test_without_any_room_one_line_names_the_folder_and_the_variable(tmp_path):
    cached, temporary = tmp_path / "cache", tmp_path / "temporary"
    temporary.mkdir()
    with pytest.raises(subprocess.CalledProcessError) as caught:
        run(cached, TMPDIR=str(temporary), LARGEST="130000")
    last = caught.value.stderr.strip().splitlines()[-1]
    assert (
        f"InputError: {cached} has no room for 32 MB of compiled kernels, and {temporary} has no room for them, either; " in last
    )
    assert last.endswith("set FLEXARM_CACHE to a folder that can be written, with room")
    assert list(temporary.iterdir()) == []
    run(cached)
    made = run(cached, LARGEST="130000")  # what is compiled needs no room
    assert (made.stdout, made.stderr) == ("42 42\n", "")
