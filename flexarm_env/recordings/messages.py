"""Texts of a person's files in messages: quoted, cut short, on one line."""

from __future__ import annotations

from pathlib import Path

from flexarm_env.errors import InputError, printable
from flexarm_env.recordings.clock import RestartError

_LONGEST = 40
_LONGEST_MESSAGE = 800


def quoted(text: str) -> str:
    """Quote a file's text, cut to the room in a message."""
    return repr(text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}...")


def file_error(path: Path, what: object) -> InputError:
    """Make the error of a file. Characters of path or content that would break the line are escaped, long content is cut."""
    if isinstance(what, RestartError):
        return what.of(str(path))
    text = printable(str(what))
    return InputError(f"{path}: " + (text if len(text) <= _LONGEST_MESSAGE else f"{text[: _LONGEST_MESSAGE - 3]}..."))
