"""Kept cells of an evaluation: a killed run goes on from them to the same bits, and none of other work or damaged is used."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from documents import PROJECT

from agents import cells
from agents.cells import MARK, compute_cells, program_digest, read_cell
from agents.seal import sealed
from flexarm_env import Arm

SEEDS = (0, 1, 2, 3)


def draw(log: str, seed: int, *others: object) -> dict[str, np.ndarray]:
    """Note a cell that is computed, and draw its values. The third is killed where a file says so."""
    if seed == 2 and Path(f"{log}.kill").exists():
        os.kill(os.getpid(), signal.SIGKILL)
    with Path(log).open("a") as file:
        file.write(f"{seed}\n")
    values = np.random.default_rng(seed).normal(size=(3, 50))
    return {"by_run": values, "by_arm": np.asfortranarray(values), "every_other": values[:, ::2], "flags": values[:, 0] > 0.0}


def run(folder: Path, *others: object, jobs: int = 1) -> tuple[dict, list[int]]:
    """Compute four cells; return them, and those that were not kept."""
    log = folder / "log"
    log.write_text("")
    found = compute_cells({(str(seed),): (draw, (str(log), seed, *others)) for seed in SEEDS}, folder / "cells", jobs)
    return found, [int(line) for line in log.read_text().split()]


def bits(found: dict) -> dict:
    arrays = {(*cell, name): array for cell, values in found.items() for name, array in values.items()}
    return {name: (array.dtype, array.shape, array.strides, array.tobytes("A")) for name, array in arrays.items()}


def test_a_killed_run_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    whole, made = run(tmp_path)
    assert made == [0, 1, 2, 3]
    (tmp_path / "cells").rename(tmp_path / "others")
    (tmp_path / "log.kill").touch()
    paths = os.pathsep.join(map(str, (PROJECT, PROJECT / "tests")))
    code = f"import pathlib, {__name__} as own; own.run(pathlib.Path({str(tmp_path)!r}))"
    killed = subprocess.run([sys.executable, "-c", code], env=os.environ | {"PYTHONPATH": paths}, cwd=PROJECT, timeout=120)
    assert killed.returncode == -signal.SIGKILL
    (tmp_path / "log.kill").unlink()
    found, made = run(tmp_path)
    assert made == [2, 3]
    assert list(found) == list(whole)
    assert bits(found) == bits(whole)


def test_processes_find_what_one_finds(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    one, two = run(tmp_path / "one")[0], run(tmp_path / "two", jobs=2)[0]
    assert bits(one) == bits(two)
    assert run(tmp_path / "two")[1] == []


def policy(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path


@pytest.mark.parametrize(
    ("before", "after"),
    [
        pytest.param(lambda path: 3, lambda path: 4, id="count"),
        pytest.param(lambda path: [policy(path, b"a")], lambda path: [policy(path, b"b")], id="policy of one name"),
        pytest.param(lambda path: Arm.load("thesis"), lambda path: Arm.load("thesis-fem"), id="arm"),
    ],
)
def test_a_kept_cell_of_other_work_is_not_used(
    before: Callable[[Path], object], after: Callable[[Path], object], tmp_path: Path
) -> None:
    path = tmp_path / "a.safetensors"
    run(tmp_path, before(path))
    assert run(tmp_path, before(path))[1] == []
    assert run(tmp_path, after(path))[1] == [0, 1, 2, 3]


def test_a_kept_cell_of_another_program_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in cells.SOURCES:
        (tmp_path / "project" / folder).mkdir(parents=True)
    source = tmp_path / "project" / "flexarm_env" / "a.py"
    monkeypatch.setattr(cells, "PROJECT", tmp_path / "project")
    source.write_text("GAIN = 1.0")
    run(tmp_path)
    assert run(tmp_path)[1] == []
    source.write_text("GAIN = 2.0")
    assert run(tmp_path)[1] == [0, 1, 2, 3]
    digest = program_digest()
    monkeypatch.setattr(cells, "distributions", lambda: [])
    assert program_digest() != digest


def flipped(content: bytes, place: int) -> bytes:
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


#: Of an entry in a zip's directory; 33 bytes further is the length of a comment, which would hide the entries after it.
ENTRY = b"PK\x01\x02"


@pytest.mark.parametrize(
    "damaged",
    [
        pytest.param(lambda content: b"", id="empty"),
        pytest.param(lambda content: content[:-100], id="cut"),
        pytest.param(lambda content: flipped(content, len(content) // 2), id="a bit of a value"),
        pytest.param(lambda content: flipped(content, content.index(ENTRY) + 33), id="a bit that hides arrays"),
    ],
)
def test_a_damaged_kept_cell_is_computed_again(damaged: Callable[[bytes], bytes], tmp_path: Path) -> None:
    whole, _ = run(tmp_path)
    place = kept(tmp_path)[0]
    place.write_bytes(damaged(place.read_bytes()))
    found, made = run(tmp_path)
    assert len(made) == 1
    assert bits(found) == bits(whole)
    assert run(tmp_path)[1] == []


def kept(folder: Path) -> list[Path]:
    return sorted((folder / "cells").iterdir())


class Harm:
    def __init__(self, place: Path) -> None:
        self.place = place

    def __reduce__(self) -> tuple:
        return (Path.touch, (self.place,))


@pytest.mark.parametrize("form", ["pickle", "array", "zip"])
def test_reading_a_kept_cell_runs_no_code(form: str, tmp_path: Path) -> None:
    harm = np.array([Harm(tmp_path / "harmed")], dtype=object)
    place = tmp_path / "a.cell"
    if form == "array":
        np.savez(tmp_path / "a.npz", harm=harm)
        content = (tmp_path / "a.npz").read_bytes()
    else:
        content = pickle.dumps(harm) if form == "pickle" else b"PK\x03\x04 and no more"
    place.write_bytes(sealed(MARK, content))
    assert read_cell(place) is None
    assert not (tmp_path / "harmed").exists()


def test_the_progress_counts_kept_cells_and_estimates_by_the_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown = []

    @contextmanager
    def bar(title: str) -> Iterator[Callable[[float, str], None]]:
        yield lambda share, text: shown.append((share, text))

    run(tmp_path)
    for place in kept(tmp_path):
        if np.array_equal(read_cell(place)["by_run"], draw(str(tmp_path / "log"), 1)["by_run"]):
            place.unlink()
    monkeypatch.setattr(cells, "progress", bar)
    assert run(tmp_path)[1] == [1]
    assert shown == [(0.0, "3 of 4"), (1.0, "4 of 4: 1")]
