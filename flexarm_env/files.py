"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from flexarm_env.errors import InputError


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file, text as UTF-8, beside its place, then move it there.

    Raises:
        InputError: if the place cannot be written.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        try:
            with draft.open("xb") as file:
                file.write(content.encode() if isinstance(content, str) else content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(draft, path)
        finally:
            draft.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}; name a folder that exists and can be written") from None
