"""Cells of an evaluation, each kept in a file as soon as it is computed: an interrupted run goes on at the first missing one.

joblib.Memory and diskcache keep results as pickles, which run code as they are read, and know a function again by its own text,
not by that of the functions that it calls.
"""

from __future__ import annotations

import hashlib
import io
import sys
from collections.abc import Mapping, Sequence
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

import numpy as np

from agents.seal import sealed, unsealed
from flexarm_env.arm import Arm
from flexarm_env.arm_text import arm_text
from flexarm_env.files import read_whole, write_whole
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.workers import Task, Workers
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.progress import progress

#: A kept cell is sealed: the checksums within a zip do not cover its directory, where one wrong bit hides arrays.
MARK = b"flexarm-cell-1\n"
LARGEST_FILE = 100_000_000
PROJECT = Path(__file__).resolve().parent.parent
#: Folders and kinds of the files on which a cell may depend.
SOURCES, SUFFIXES = ("agents", "configs", "flexarm_env", "tests/rig"), (".py", ".toml")

Name = tuple[str, ...]
#: Arrays by the names of measures.
Values = Mapping[str, np.ndarray]


def compute_cells(work: Mapping[Name, Task], folder: Path, jobs: int) -> dict[Name, Values]:
    """Compute cells in processes, except those that an interrupted run has kept; show the progress and the time left.

    A kept cell is used where the same function, arguments, sources and libraries would make it again.

    Args:
        work: by the name of each cell a function that returns its arrays, and plain arguments, arms and files.
        folder: of the kept cells; it is made.
        jobs: processes.

    Returns:
        The arrays of each cell, in the order of the work.

    Raises:
        InputError: if the folder cannot be written, or a file cannot be read.
    """
    make_folder(folder)
    program = program_digest()
    places = {name: folder / f"{cell_digest(program, task)}.cell" for name, task in work.items()}
    found = {name: kept for name, place in places.items() if (kept := read_cell(place)) is not None}
    missing = [name for name in work if name not in found]
    # Of a larger batch joblib returns all cells at once, when the last is computed.
    running = Workers(jobs, batch=1).spread([(_compute, (*work[name], places[name])) for name in missing])
    with progress("evaluating") as bar:
        show = Progress.to(bar).at
        show(0.0, f"{len(found)} of {len(work)}")
        for done, (name, values) in enumerate(zip(missing, running, strict=True), 1):
            found[name] = values
            show(done / len(missing), f"{len(found)} of {len(work)}: {' · '.join(name)}")
    return {name: found[name] for name in work}


def program_digest() -> str:
    """Compute the digest of the sources, of Python and of all libraries: a change in any may change a cell."""
    files = (path for folder in SOURCES for path in sorted((PROJECT / folder).rglob("*")) if path.suffix in SUFFIXES)
    sources = [(str(path.relative_to(PROJECT)), _file_digest(path)) for path in files]
    libraries = sorted({f"{one.name} {one.version}" for one in distributions()})
    return _digest(repr([sys.version, libraries, sources]).encode())


def cell_digest(program: str, task: Task) -> str:
    """Compute the digest of a task under a program: of its function's name and its arguments, of files and arms the content."""
    function, arguments = task
    return _digest(repr([program, function.__module__, function.__qualname__, _stated(arguments)]).encode())


def read_cell(place: Path) -> Values | None:
    """Read a kept cell without running code of it; None where there is none, or it is damaged."""
    try:
        content = unsealed(MARK, read_whole(place, LARGEST_FILE, "delete it"))
        return None if content is None else _unpacked(content)
    except Exception:  # a forged file: numpy lets through whatever its reader meets
        return None


def _compute(function: Any, arguments: Sequence[Any], place: Path) -> Values:
    """Compute a cell and keep it. What is returned went through the same format as a kept one, order of memory included."""
    packed = io.BytesIO()
    np.savez(packed, **function(*arguments))
    write_whole(place, sealed(MARK, packed.getvalue()))
    return _unpacked(packed.getvalue())


def _unpacked(content: bytes) -> Values:
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        return dict(arrays)


def _stated(value: Any) -> Any:
    """Replace files and arms in arguments by their content."""
    if isinstance(value, (list, tuple)):
        return [_stated(part) for part in value]
    if isinstance(value, Path):
        return _file_digest(value)
    return arm_text(value) if isinstance(value, Arm) else value


def _file_digest(path: Path) -> str:
    return _digest(read_whole(path, LARGEST_FILE, "name a file that can be read"))


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
