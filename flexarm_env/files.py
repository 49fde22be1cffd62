"""Atomic writing of files, and bounded reading of TOML files."""

from __future__ import annotations

import os
import stat
import tomllib
import uuid
from pathlib import Path
from typing import Any

from flexarm_env.errors import InputError

LARGEST_TOML = 1_000_000


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file atomically, text as UTF-8: first beside its place, then moved there. A link's target is written.

    Raises:
        InputError: if the place cannot be written, or is no regular file.
    """
    place = Path(os.path.realpath(path))
    try:
        if not path.name or (place.exists() and not place.is_file()):
            raise InputError(f"cannot write {path}: it is no regular file; name another")
        draft = place.with_name(f".{uuid.uuid4().hex}.tmp")
        try:
            with draft.open("xb") as file:
                file.write(content.encode(errors="replace") if isinstance(content, str) else content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(draft, place)
        finally:
            draft.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}; name a folder that exists and can be written") from None


def read_toml(path: Path) -> dict[str, Any]:
    """Read the tables of a TOML file in UTF-8, with or without a byte order mark.

    Raises:
        InputError: if it is no regular file, too large, or not TOML.
    """
    try:
        status = path.stat()
        regular = stat.S_ISREG(status.st_mode)  # a pipe is not opened: it would wait for ever
        content = path.read_bytes() if regular and status.st_size <= LARGEST_TOML else b""
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; name a TOML file that can be read") from None
    if not regular:
        raise InputError(f"{path}: is no regular file; name a TOML file")
    if status.st_size > LARGEST_TOML:
        raise InputError(f"{path}: is larger than {LARGEST_TOML} bytes; name a TOML file")
    try:
        return tomllib.loads(content.decode("utf-8-sig"))
    except RecursionError:
        raise InputError(f"{path}: is not TOML that can be read: its values are nested too deeply") from None
    except ValueError as error:
        raise InputError(f"{path}: is not TOML: {' '.join(str(error).split())}") from None
