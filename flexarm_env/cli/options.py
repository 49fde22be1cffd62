"""Arguments and options that several commands share."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from flexarm_env.arm_file import shipped_arms


def place(text: str) -> Path:
    """Make the path of a file that is written; a Path would drop the slash that says a folder.

    Raises:
        BadParameter: for a folder.
    """
    if text.endswith(("/", os.sep)):
        raise typer.BadParameter(f"{text} is a folder; name a file in it")
    return Path(text)


_RECORDINGS = typer.Argument(metavar="RECORDING…", help="Recordings (.csv, .mat, …), or folders of them.", show_default=False)
Recordings = Annotated[list[Path], _RECORDINGS]
RecordingsOrNone = Annotated[list[Path] | None, _RECORDINGS]
_ARMS = ", ".join(sorted(shipped_arms()))
ArmName = Annotated[str, typer.Option("--arm", metavar="ARM", help=f"Arm file, or a shipped arm: {_ARMS}.")]
Columns = Annotated[
    Path | None,
    typer.Option(metavar="FILE.toml", help="How foreign recordings name their columns: a \\[columns] table."),
]
Effects = Annotated[
    list[str] | None,
    typer.Option(metavar="FILE.py:Name", help="An effect of your own, besides the catalogue; may be repeated. Runs FILE.py."),
]
Json = Annotated[
    Path | None, typer.Option("--json", parser=place, metavar="FILE", help="Write the result as JSON; - for stdout.")
]
Report = Annotated[Path | None, typer.Option(parser=place, metavar="FILE.html", help="Write a page with figures.")]
Save = Annotated[Path | None, typer.Option(parser=place, metavar="ARM.toml", help="Write the arm that results.")]
Rate = Annotated[
    float | None,
    typer.Option(metavar="HZ", help="Samples per second to keep; 0 keeps all.", show_default="as many as the arm needs"),
]
Seed = Annotated[int, typer.Option(min=0, help="Seed of all random draws.")]
