"""Every kind of file that the program reads, in every form that is none: one line, at once, and nothing waits or runs."""

from __future__ import annotations

import gzip
import importlib.util
import json
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from benchmarks.fuzz.corpus import corpus
from flexarm_env.arm import Arm
from flexarm_env.controllers.tuned import TunedController, tuned_folders
from flexarm_env.effects import load_effect
from flexarm_env.errors import InputError
from flexarm_env.files import read_json
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.recording import Recording
from flexarm_env.tuning.spaces import Range
from flexarm_env.tuning.study import Study

GOOD = b"time [s],current [A],arm_angle [rad]\n0,1,0.5\n0.1,2,0.6\n0.2,3,0.7\n"
OWN = b"from flexarm_env.effects import Effect\n"
JSON_MAP = {name: {"variable": f"rows.{name[0]}", "unit": unit} for name, unit in (("time", "s"), ("current", "A"))}
JSON_MAP["arm_angle"] = {"variable": "rows.a", "unit": "rad"}
JSON_LOG = json.dumps({"rows": [{"t": 0.1 * k, "c": k, "a": 0.1 * k} for k in range(9)]}).encode()
TRAINED = importlib.util.find_spec("stable_baselines3") is not None
#: Longest time [s] that a file may take.
PATIENCE = 10

Reader = tuple[str, bytes, Callable[[Path], object]]


def sidecar(path: Path) -> object:
    path.with_suffix(".csv").write_bytes(GOOD)
    return Recording.read(path.with_suffix(".csv"))


def lerobot_info(path: Path) -> object:
    """Read a file of a LeRobot data set, with its info as given."""
    place = path.parent / "set" / "data" / "chunk-000" / "file-000.parquet"
    place.parent.mkdir(parents=True)
    place.write_bytes(PARQUET.content)
    (path.parent / "set" / "meta").mkdir()
    if os.path.lexists(path):
        path.rename(path.parent / "set" / "meta" / "info.json")
    return Recording.read(place, PARQUET.columns)


def readers() -> Iterator[tuple[str, Reader]]:
    for number, sound in enumerate(corpus()["recording"]):
        name = f"recording {number}{sound.suffix}"
        yield name, (sound.suffix, sound.content, lambda path, columns=sound.columns: Recording.read(path, columns))
    yield "recording.json", (".json", JSON_LOG, lambda path: Recording.read(path, JSON_MAP))
    yield "sidecar", (".toml", b"[conditions]\npayload = '0.3 kg'\n", sidecar)
    yield "arm", (".toml", corpus()["arm"][0].content, Arm.load)
    yield "column map", (".toml", corpus()["columns"][0].content, load_columns)
    tuned = sorted(tuned_folders()[-1].glob("*.toml"))[0].read_bytes()
    yield "controller", (".toml", tuned, TunedController.load)
    yield "effect", (".py", OWN, lambda path: load_effect(f"{path}:Mine"))
    yield "stored result", (".json", b'{"case": {}}', lambda path: read_json(path, "delete it"))
    if importlib.util.find_spec("optuna") is not None:
        yield "journal", (".journal", b'{"op_code": 0}\n', lambda path: Study("it", {"x": Range(0.1, 1.0)}, path))
    if PARQUET is not None:
        yield "info of a data set", (".json", b'{"features": {}}', lerobot_info)
    if TRAINED:
        from agents.learning.artefact import Artefact
        from agents.learning.checkpoint import MARK, read_checkpoint
        from agents.learning.plan_file import read_plan

        yield "policy", (".safetensors", corpus()["policy"][0].content, Artefact.load)
        yield "checkpoint", (".checkpoint", MARK + 64 * b"0", read_checkpoint)
        yield "plan", (".toml", b'task = "slew"\nactions = 1000\n', read_plan)


PARQUET = next((sound for sound in corpus()["recording"] if sound.suffix == ".parquet"), None)
READERS = dict(readers())
#: Files that are none, by what is wrong.
NO_FILES: dict[str, Callable[[Path], object]] = {
    "folder": lambda path: path.mkdir(),
    "pipe": os.mkfifo,
    "link loop": lambda path: path.symlink_to(path.name),
    "dangling link": lambda path: path.symlink_to("nowhere"),
    "absent": lambda path: None,
}
#: Content in other forms, by what is wrong.
FORMS: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda content: b"",
    "blank": lambda content: b" \n\n",
    "binary": lambda content: np.random.default_rng(0).bytes(4096),
    "zeros": lambda content: bytes(4096),
    "gzip": gzip.compress,
    "UTF-16": lambda content: content.decode("latin-1").encode("utf-16"),
    "a page": lambda content: b"<!DOCTYPE html>\n<html><head><title>404</title></head><body>Not found</body></html>\n",
    "a pointer to large storage": lambda content: b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 123\n",
    "nested lists": lambda content: 100_000 * b"[",
    "nested tables": lambda content: 50_000 * b'{"a":',
    "deep TOML": lambda content: b"a = " + 5_000 * b"[" + 5_000 * b"]",
    "a key of 30 000 parts": lambda content: b"[columns]\nx" + 30_000 * b".a" + b" = 1\n",
    "a key of 1500 parts": lambda content: b"[conditions]\nx" + 1_500 * b".a" + b" = 1\n",
    "tables in tables": lambda content: b"[conditions]\n" + 20 * (b"x" + 40 * b".a" + b" = {") + 20 * b"}",
    "one long line": lambda content: 1_000_000 * b"a",
    "another kind": lambda content: b"[other]\nkey = 1\n" if content.startswith(b"{") else b'{"other": [1, 2]}\n',
    "a list": lambda content: b"[1, 2, 3]\n",
}
#: What is right all the same: a new journal is begun, a recording has nothing beside it, all of a plan has defaults.
READ = {
    "journal": {"absent", "empty", "dangling link"},
    "sidecar": {"absent", "folder"},
    "info of a data set": {*NO_FILES, "UTF-16"},
    "recording.json": {"UTF-16"},
    "stored result": {"UTF-16"},
    "plan": {"empty", "blank"},
}


@contextmanager
def in_time() -> Iterator[None]:
    def late(number: int, frame: object) -> None:
        raise TimeoutError(f"no answer in {PATIENCE} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(PATIENCE)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def refused(read: Callable[[Path], object], path: Path) -> str | None:
    """Read a file; return the line with which it is refused, None where it is read."""
    with in_time():
        try:
            read(path)
        except InputError as error:
            return str(error)
    return None


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("kind", NO_FILES)
def test_what_is_no_file_is_refused_by_every_reader(reader, kind, tmp_path):
    suffix, _, read = READERS[reader]
    path = tmp_path / f"odd{suffix}"
    NO_FILES[kind](path)
    line = refused(read, path)
    assert (line is None) == (kind in READ.get(reader, ())), line
    assert line is None or (len(line) < 500 and line.isprintable()), line


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("form", FORMS)
def test_a_file_in_another_form_is_refused_by_every_reader(reader, form, tmp_path):
    suffix, content, read = READERS[reader]
    path = tmp_path / f"odd{suffix}"
    path.write_bytes(FORMS[form](content))
    line = refused(read, path)
    assert (line is None) == (form in READ.get(reader, ())), line
    assert line is None or (len(line) < 500 and line.isprintable()), line


@pytest.mark.parametrize("reader", READERS)
def test_a_sound_file_is_read_or_refused_in_one_line_when_it_is_cut_off_anywhere(reader, tmp_path):
    suffix, content, read = READERS[reader]
    for share in (0.02, 0.3, 0.5, 0.7, 0.98):
        folder = tmp_path / f"{share}"
        folder.mkdir()
        path = folder / f"cut{suffix}"
        path.write_bytes(content[: int(share * len(content))])
        line = refused(read, path)
        assert line is None or (len(line) < 500 and line.isprintable()), line
