"""What the commands write: JSON with its provenance, pages, arm files; each whole or not at all."""

from __future__ import annotations

import importlib.util
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import flexarm_env
from flexarm_env.errors import InputError
from flexarm_env.files import write_whole
from flexarm_env.recordings.recording import Recording

STDOUT = Path("-")


def check_places(json: Path | None, *others: Path | None, read: Iterable[Path] = ()) -> None:
    """Refuse places that cannot be written, before an hour's work is done.

    Args:
        json: for the JSON, which alone may go to stdout ("-").
        others: for whatever else is written.
        read: files and folders that are read, none of which may be written over.

    Raises:
        InputError: for a folder that is not there or not writable, a place that holds no file, or one that is used twice.
    """
    used = {os.path.realpath(file) for path in read for file in (path.iterdir() if path.is_dir() else [path])}
    for path in (json, *others):
        if path is None or (path == STDOUT and path is json):
            continue
        if path == STDOUT:
            raise InputError("only --json writes to stdout; name a file in the place of -")
        if path.is_dir():
            raise InputError(f"cannot write {path}: it is a folder; name a file in it")
        if path.exists() and not path.is_file():
            raise InputError(f"cannot write {path}: it is no regular file; name another")
        place = os.path.realpath(path)
        if place in used:
            raise InputError(f"cannot write {path}: the same command reads or writes it already; name another file")
        used.add(place)
        if not path.parent.is_dir():
            raise InputError(f"cannot write {path}: there is no folder {path.parent}; make it first")
        if not os.access(path.parent, os.W_OK):
            raise InputError(f"cannot write {path}: folder {path.parent} is not writable; name another")
        if path.exists() and not os.access(path, os.W_OK):
            raise InputError(f"cannot write {path}: it is there and must not be written; name another")


def need_plots() -> None:
    """Refuse pictures where their library is missing."""
    missing = [name for name in ("plotly", "matplotlib") if importlib.util.find_spec(name) is None]
    if missing:
        raise InputError(f"pictures need {' and '.join(missing)}; pip install 'flexarm-env[plots]'")


def need_lab() -> None:
    """Refuse the lab where its libraries are missing."""
    missing = [name for name in ("nicegui", "plotly") if importlib.util.find_spec(name) is None]
    if missing:
        raise InputError(f"the lab needs {' and '.join(missing)}; pip install 'flexarm-env[lab]'")


def write_json(path: Path | None, content: Mapping[str, Any]) -> None:
    """Write a result as JSON to a file, or to stdout for "-"; numbers that are none become null."""
    if path is None:
        return
    text = json.dumps(_plain(content), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    if path == STDOUT:
        sys.stdout.write(text)
    else:
        write_whole(path, text)


def provenance(command: str, arm: str, recordings: Sequence[Recording], seed: int | None) -> dict[str, Any]:
    """Return what a reader needs in order to trust or redo a result."""
    made: dict[str, Any] = {
        "command": command,
        "version": flexarm_env.__version__,
        "commit": commit(),
        "arm": arm,
        "recordings": [{"name": r.name, "sha256": r.sha256} for r in recordings],
    }
    return made if seed is None else made | {"seed": seed}


def commit() -> str | None:
    """Return the commit of this source tree, with "+" if files differ from it; None where it is no checkout."""
    here = Path(__file__).resolve().parent.parent

    def git(*arguments: str) -> str:
        run = subprocess.run(["git", "-C", here, *arguments], capture_output=True, text=True, timeout=5, check=True)
        return run.stdout.strip()

    try:
        git("ls-files", "--error-unmatch", "__init__.py")
        return git("rev-parse", "HEAD") + ("+" if git("status", "--porcelain", "--untracked-files=no", ".") else "")
    except (OSError, subprocess.SubprocessError):
        return None


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
