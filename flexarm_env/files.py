"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from flexarm_env.errors import InputError


def write_whole(path: Path, text: str) -> None:
    """Write a text file beside its place, then move it there.

    Raises:
        InputError: if the place cannot be written.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        try:
            with draft.open("x", encoding="utf-8", newline="\n") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            os.replace(draft, path)
        finally:
            draft.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}; name a folder that exists and can be written") from None
