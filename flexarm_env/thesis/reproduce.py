"""Reproduction of the thesis into a folder: claims checked, figures drawn."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from collections.abc import Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from flexarm_env import __version__
from flexarm_env.files import write_whole
from flexarm_env.terminal import outputs, tables
from flexarm_env.terminal.progress import Progress, progress
from flexarm_env.terminal.provenance import provenance
from flexarm_env.thesis import arms
from flexarm_env.thesis.claims import ROWS, Claim
from flexarm_env.thesis.errata import Erratum, errata
from flexarm_env.thesis.figures import CHAPTERS
from flexarm_env.thesis.page import MARKS, page, summary
from flexarm_env.thesis.runs import INTERVAL
from flexarm_env.thesis.sheet import Sheet

PAGE, NUMBERS = "index.html", "thesis.json"


def reproduce(output: Path, json: Path | None = None) -> None:
    """Check every claim and draw every figure.

    Args:
        output: folder for the page, the figures and the numbers; it is created.
        json: a second file for the numbers.

    Raises:
        InputError: if the folder cannot be made or written.
    """
    outputs.make_folder(output, PAGE, NUMBERS)
    with progress("the thesis") as move:
        claims, found, sheets = _work(output, move)
    content: dict[str, Any] = {"claims": [claim.as_json() for claim in claims], "errata": [e.as_json() for e in found]}
    content |= {"figures": {s.number: {"title": s.title, "file": s.stem} for drawn in sheets.values() for s in drawn}}
    content |= provenance("thesis", "thesis", [], None)
    commit = content["commit"]
    made = f"FlexArm {__version__}" + (f", commit {commit}" if commit else "")
    write_whole(output / PAGE, page(claims, found, sheets, made))
    outputs.write_json(output / NUMBERS, content)
    outputs.write_json(json, content)
    _say(output, claims, found, json)


def _work(output: Path, move: Progress | None) -> tuple[list[Claim], list[Erratum], dict[str, list[Sheet]]]:
    """Compute claims, misprints and figures; other processes draw meanwhile."""
    steps = len(CHAPTERS) + len(ROWS) + 2

    def tell(done: int, words: str) -> None:
        if move is not None:
            move(done / steps, words)

    began = time.monotonic()
    pool = _pool()
    try:
        # on the first use both compile, the plant here and the loops there
        ready = pool.submit(_compile_loops)
        tell(0, "compiling")
        arms.combined().plant(INTERVAL)
        ready.result()
        drawn: list[Future[None]] = []
        sheets: dict[str, list[Sheet]] = {}
        for k, (chapter, build) in enumerate(CHAPTERS.items()):
            tell(k, f"figures of {chapter}")
            sheets[chapter] = build()
            drawn += [pool.submit(_draw, sheet, output) for sheet in sheets[chapter]]
        tell(len(CHAPTERS), "misprints")
        found, claims = errata(), []
        for k, row in enumerate(ROWS):
            tell(len(CHAPTERS) + 1 + k, f"claim T{k + 1}")
            claims.append(row())
        tell(steps - 1, f"drawing, after {time.monotonic() - began:.0f} s")
        for future in drawn:
            future.result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
    return claims, found, sheets


def _pool() -> ProcessPoolExecutor:
    """Start processes for drawing: spawned, since a fork of a process with threads may hang."""
    count = max(1, min(4, (os.cpu_count() or 1) - 1))
    return ProcessPoolExecutor(count, multiprocessing.get_context("spawn"), initializer=_ignore_interrupt)


def _ignore_interrupt() -> None:
    """Leave Ctrl-C to the parent process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _compile_loops() -> None:
    """Compile the loops into numba's cache beside the plant."""
    from flexarm_env.thesis import fixed_step, impact, kernels
    from flexarm_env.thesis.law import Law

    kernels.player()
    fixed_step.simulate(fixed_step.pinned(), Law(), 1e-5, 1e-5, 1e-5)
    impact.follow(np.zeros(1), impact.STEP)


def _draw(sheet: Sheet, output: Path) -> None:
    from flexarm_env.thesis import draw

    draw.save(draw.draw(sheet), output / sheet.stem)


def _say(output: Path, claims: Sequence[Claim], found: Sequence[Erratum], json: Path | None) -> None:
    from rich.text import Text

    out = tables.console(to_stderr=json == outputs.STDOUT)
    rows = [[claim.key, claim.words, f"{MARKS[claim.verdict]} {claim.verdict}"] for claim in claims]
    tables.show(out, tables.text_table("Claims of the thesis", ["", "the thesis says", "verdict"], rows))
    out.print(
        Text(
            f"{summary(claims)} {len(found)} effects of misprints. In {output}: {PAGE}, {NUMBERS}, and the figures as SVG "
            "and PNG."
        )
    )
