"""Atomic writing of files, and bounded reading of regular ones."""

from __future__ import annotations

import json
import os
import re
import stat
import tomllib
import uuid
from pathlib import Path
from typing import Any

from flexarm_env.errors import InputError

LARGEST_TOML = 1_000_000
LARGEST_JSON = 100_000_000
#: Tables within tables of a TOML file: no file of this program has ten.
DEEPEST_TOML = 50
# A dotted key of tens of thousands of parts takes the parser time and memory that grow with their square. Possessive, and begun
# at the start of a word alone, so that no line takes time that grows faster than its length.
_PART = r"(?:[\w-]++|\"[^\"\n]*+\"|'[^'\n]*+')"
_LONG_KEY = re.compile(rf"(?<![\w-])(?:{_PART}[ \t]*+\.[ \t]*+){{{DEEPEST_TOML}}}")


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


def check_file(path: Path, largest: int, remedy: str) -> None:
    """Refuse to open what is no regular file, where a pipe would wait for ever, or is too large.

    Args:
        path: of the file.
        largest: size [bytes].
        remedy: end of a message, such as "name a TOML file".

    Raises:
        InputError: for such a file, or one that is not there.
    """
    try:
        status = path.stat()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; {remedy}") from None
    if not stat.S_ISREG(status.st_mode):
        raise InputError(f"{path}: is no regular file; {remedy}")
    if status.st_size > largest:
        raise InputError(f"{path}: is larger than {largest} bytes; {remedy}")


def read_whole(path: Path, largest: int, remedy: str) -> bytes:
    """Read a file. Arguments as `check_file`.

    Raises:
        InputError: if it is no regular file, too large, or cannot be read.
    """
    check_file(path, largest, remedy)
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; {remedy}") from None


def read_toml(path: Path, remedy: str = "name a TOML file") -> dict[str, Any]:
    """Read the tables of a TOML file in UTF-8, with or without a byte order mark.

    Args:
        path: of the file.
        remedy: end of a message.

    Raises:
        InputError: if it is no regular file, too large, or not TOML.
    """
    content = read_whole(path, LARGEST_TOML, remedy)
    try:
        text = content.decode("utf-8-sig")
    except ValueError as error:
        raise InputError(f"{path}: is not TOML: {error}") from None
    return parse_toml(text, str(path))


def parse_toml(text: str, where: str) -> dict[str, Any]:
    """Parse the tables of a TOML text that may come from anyone, in time that grows as its length.

    Args:
        text: without a byte order mark.
        where: it stands, for messages.

    Raises:
        InputError: if it is too long, or not TOML.
    """
    if len(text) > LARGEST_TOML:
        raise InputError(f"{where}: is longer than {LARGEST_TOML} characters; such a text is no TOML of this program")
    try:
        tables = None if _LONG_KEY.search(text) else tomllib.loads(text)
    except RecursionError:
        tables = None
    except ValueError as error:
        raise InputError(f"{where}: is not TOML: {' '.join(str(error).split())}") from None
    if tables is None or _is_deep(tables):
        raise InputError(f"{where}: is not TOML that can be read: its values are nested too deeply")
    return tables


def _is_deep(tables: dict[str, Any]) -> bool:
    """Whether tables and lists lie deeper in each other than `DEEPEST_TOML`; Python could not even write those in a message."""
    level: list[Any] = [tables]
    for _ in range(DEEPEST_TOML):
        inside = (value for one in level for value in (one.values() if isinstance(one, dict) else one))
        level = [value for value in inside if isinstance(value, dict | list)]
    return bool(level)


def read_json(path: Path, remedy: str) -> dict[str, Any]:
    """Read a table of JSON that a program has written before.

    Args:
        path: of the file.
        remedy: end of a message, such as "delete it to make it anew".

    Raises:
        InputError: if it is no regular file, too large, or no table of JSON.
    """
    content = read_whole(path, LARGEST_JSON, remedy)
    try:
        found = json.loads(content)
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise InputError(f"{path}: is damaged, or no table of JSON; {remedy}")
    return found
