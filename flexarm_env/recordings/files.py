"""Which files the paths name that a user gives."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from flexarm_env.errors import InputError
from flexarm_env.recordings.formats.text import fault

PathLike = str | os.PathLike[str]


def files_of(paths: Iterable[PathLike]) -> list[Path]:
    """Return the files that paths name, folders replaced by their CSV files, in order."""
    files: list[Path] = []
    for path in map(Path, paths):
        try:
            inside = sorted(p for p in path.iterdir() if is_csv(p)) if path.is_dir() else [path]
        except OSError as error:
            raise fault(path, f"cannot be read: {error.strerror}; check its permissions") from None
        if not inside:
            raise fault(path, "a folder without CSV files; name the files, or another folder")
        files += inside
    if not files:
        raise InputError("no recordings; name a file or a folder")
    places = [os.path.realpath(file) for file in files]
    for i, place in enumerate(places):
        if place in places[:i]:
            raise fault(files[i], "named twice; name each recording once")
    return files


def is_csv(path: Path) -> bool:
    """Whether a path is a CSV file that is not hidden."""
    return path.suffix.lower() == ".csv" and not path.name.startswith(".") and not path.is_dir()
