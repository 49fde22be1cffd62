"""The files that a user's paths name, and their content."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Sequence
from pathlib import Path

from flexarm_env.errors import InputError
from flexarm_env.recordings.formats.catalogue import folder_suffixes, suffixes
from flexarm_env.recordings.formats.lerobot import data_files
from flexarm_env.recordings.messages import file_error
from flexarm_env.recordings.table import LARGEST_FILE

PathLike = str | os.PathLike[str]


def read_bytes(path: Path) -> bytes:
    """Read the content of a regular file.

    Raises:
        InputError: if it is absent, empty, larger than `LARGEST_FILE`, no file, or not to be opened.
    """
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):  # not opened: a pipe would wait for ever
            content = None
        else:
            content = path.read_bytes() if status.st_size <= LARGEST_FILE else b""
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot be read: {reason}; check the path and its permissions") from None
    if content is None:
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "not a regular file"
        raise InputError(f"is {kind}; name a recording saved as a file")
    if status.st_size > LARGEST_FILE:
        size, limit = status.st_size / 2**20, LARGEST_FILE / 2**20
        raise InputError(f"has {size:.0f} MB, the limit is {limit:.0f} MB; cut it into shorter recordings")
    if not content:
        raise InputError("is empty; it needs a header row and at least two samples")
    return content


def files_of(paths: Iterable[PathLike]) -> list[Path]:
    """List the files that paths name, folders replaced by the recordings in them, in order.

    Raises:
        InputError: for a folder without recordings or with one in two formats, for a file named twice, and for no files.
    """
    files: list[Path] = []
    for path in map(Path, paths):
        files += (data_files(path) or _inside(path)) if path.is_dir() else [path]
    if not files:
        raise InputError("no recordings; name a file or a folder")
    places = [os.path.realpath(file) for file in files]
    for i, place in enumerate(places):
        if place in places[:i]:
            raise file_error(files[i], "named twice; name each recording once")
    return files


def _inside(folder: Path) -> list[Path]:
    """List the recordings of a folder by name: where it has none with a suffix of its own, those of text and JSON."""
    try:
        inside = sorted(path for path in folder.iterdir() if not path.name.startswith(".") and not path.is_dir())
    except OSError as error:
        raise file_error(folder, f"cannot be read: {error.strerror}; check its permissions") from None
    files = _with_suffix(inside, folder_suffixes()) or _with_suffix(inside, suffixes())
    if not files:
        others = ", ".join(suffix for suffix in folder_suffixes() if suffix != ".csv")
        raise file_error(folder, f"a folder without CSV files or other recordings ({others}); name the files, or another folder")
    by_stem: dict[str, Path] = {}
    for file in files:
        twin = by_stem.setdefault(file.stem, file)
        if twin.suffix.lower() != file.suffix.lower():
            both = f"{twin.name} and {file.name}"
            raise file_error(folder, f"has {both}, which may be one recording in two formats; name the files to be read")
    return files


def _with_suffix(paths: Iterable[Path], allowed: Sequence[str]) -> list[Path]:
    """Select the paths with a suffix among those allowed."""
    return [path for path in paths if path.suffix.lower() in allowed]
