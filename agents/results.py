"""Results of evaluations: how they were made, and their files."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexarm_env import __version__
from flexarm_env.files import write_whole
from flexarm_env.terminal.provenance import commit


def origin_of(command: str, seed: int) -> dict[str, Any]:
    """Gather the command, version, commit and seed under which a result is made."""
    return {"command": command, "version": __version__, "commit": commit(), "seed": seed}


def cells_place(folder: Path, name: str) -> Path:
    """Locate the folder in which the cells of a result are kept until it is written."""
    return folder / f"{name}.cells"


def write_results(folder: Path, name: str, result: Mapping[str, Any], report: str) -> Path:
    """Write a result as JSON and its report as Markdown, and remove its kept cells; return the path of the report.

    Raises:
        InputError: if a file cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / f"{name}.json", json.dumps(result, indent=1, ensure_ascii=False) + "\n")
    write_whole(folder / f"{name}.md", report)
    shutil.rmtree(cells_place(folder, name), ignore_errors=True)
    return folder / f"{name}.md"
