"""Places to write to, checked before the work begins, and JSON that is written whole or not at all."""

from __future__ import annotations

import importlib.util
import json
import math
import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from flexarm_env.errors import InputError
from flexarm_env.files import write_whole

STDOUT = Path("-")
#: Suffixes of forms that no text or page has: of loggers, pictures, documents and archives.
OTHER_FORMS = frozenset(
    f".{name}"
    for name in (
        *("mat", "parquet", "mcap", "db3", "lvm", "tdms", "h5", "hdf5", "npy", "npz", "pkl", "bag"),
        *("pdf", "png", "jpg", "jpeg", "svg", "xls", "xlsx", "ods", "docx", "zip", "gz"),
    )
)
#: Suffixes of the texts that the program reads as something else than a recording in CSV.
OTHER_TEXTS = frozenset({".toml", ".json", ".html", ".py"})


def check_places(json: Path | None, *others: Path | None, read: Iterable[Path] = ()) -> None:
    """Refuse places that cannot be written, before the work begins.

    Args:
        json: for the JSON; only it may go to stdout ("-").
        others: for other files.
        read: files and folders that are read and must not be overwritten.

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


def check_suffixes(*places: Path | None, recording: Path | None = None) -> None:
    """Refuse places for text and pages with a suffix by which other programs, and the reader of recordings, expect another form.

    Args:
        places: for anything.
        recording: for a recording.

    Raises:
        InputError: for such a place.
    """
    for path in (*places, recording):
        if path is not None and path.suffix.lower() in OTHER_FORMS:
            raise InputError(
                f"cannot write {path}: it would be no {path.suffix} file; end it in .csv for a recording, .toml for an arm, "
                ".html for a page or .json"
            )
    if recording is not None and recording.suffix.lower() in OTHER_TEXTS:
        raise InputError(f"cannot write {recording}: a recording is no {recording.suffix} file; end it in .csv")


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
    """Write a result as JSON to a file, or to stdout for "-"; numbers that are not finite become null."""
    if path is None:
        return
    text = json.dumps(_plain(content), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    if path == STDOUT:
        sys.stdout.write(text)
    else:
        write_whole(path, text)


def make_folder(folder: Path, *names: str) -> None:
    """Make a folder for files of these names.

    Raises:
        InputError: if it cannot be made, or they cannot be written there.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make folder {folder}: {error.strerror}; name another") from None
    if not os.access(folder, os.W_OK):
        raise InputError(f"cannot write {folder}: the folder is not writable; name another")
    check_places(None, *(folder / name for name in names))


def _plain(value: Any) -> Any:
    """Convert a value to JSON's types."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
