"""Many damaged files, read in processes of their own."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path

from benchmarks.fuzz.attempt import Outcome, attempt, warm_up

#: Files that one process reads: a process that crashes loses no more.
CHUNK = 2000


def chunk(seed: int, first: int, count: int) -> list[Outcome]:
    """Read some files, in a process of their own."""
    with tempfile.TemporaryDirectory() as folder:
        warm_up(Path(folder))
        return [attempt(seed, number, Path(folder)) for number in range(first, first + count)]


def outcomes(seed: int, files: int) -> Iterator[Outcome]:
    """Yield what came of each file."""
    for first in range(0, files, CHUNK):
        count = min(CHUNK, files - first)
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            try:
                yield from pool.submit(chunk, seed, first, count).result()
            except BrokenProcessPool:
                yield Outcome(first, "unknown", f"a process crashed at one of {count} files")
