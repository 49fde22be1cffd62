"""The gallery from the command line: a folder of recordings becomes a folder of answers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer

from flexarm_env.files import write_whole
from flexarm_env.pictures.words import NOTHING, number
from flexarm_env.rigs.document import document
from flexarm_env.rigs.gallery import rigs_in, run
from flexarm_env.terminal import outputs, tables
from flexarm_env.terminal.progress import progress

PAGE, NUMBERS = "rigs.md", "rigs.json"


def make_gallery(folder: Path, output: Path, names: Sequence[str], jobs: int, json: Path | None = None) -> bool:
    """Examine the rigs of a folder, and write answers, pictures and a page.

    Args:
        folder: of the measurements.
        output: folder of the answers; it is created.
        names: of the rigs wanted; all by default.
        jobs: processes.
        json: a second file for the answers.

    Returns:
        Whether every rig that has a goal reaches it.

    Raises:
        InputError: for an unknown rig, a folder without recordings, and places that cannot be written.
    """
    rigs = rigs_in(folder, names)
    outputs.make_folder(output, PAGE, NUMBERS, *(f"{rig.name}.json" for rig in rigs))
    with progress("rigs") as bar:
        answers = run(rigs, folder, output, jobs, bar, _say)
    content = {"rigs": answers}
    write_whole(output / PAGE, document(answers))
    outputs.write_json(output / NUMBERS, content)
    outputs.write_json(json, content)
    tables.show(tables.console(to_stderr=json == outputs.STDOUT), tables.table("Held out", COLUMNS, map(_row, answers)))
    return all(one["reached"] for one in answers if one["goal"] is not None)


COLUMNS = ("rig", "nominal", "refitted", "with effects", "published", "goal", "missing")


def _say(answer: dict[str, Any], kept: bool) -> None:
    """Print a line on stderr after each rig."""
    figure = f"{number(answer['figures']['final'])} {answer['unit']}"
    found = ", ".join(answer["diagnosis"]["effects"]) or "nothing"
    typer.echo(f"{answer['rig']}: missing {found}; held out {figure}{', kept from before' if kept else ''}", err=True)


def _row(answer: dict[str, Any]) -> list[str]:
    def text(value: float | None) -> str:
        return NOTHING if value is None else f"{number(value)} {answer['unit']}"

    published = answer["published"][-1]["value"] if answer["published"] else None
    figures = [text(answer["figures"][step]) for step in ("nominal", "refitted", "final")]
    return [answer["rig"], *figures, text(published), text(answer["goal"]), ", ".join(answer["diagnosis"]["effects"]) or NOTHING]
