"""What a command has found, handed out: every file first, then what is printed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import RenderableType

from flexarm_env.errors import InputError
from flexarm_env.terminal import outputs, tables

#: A place, None where the user names none, and what writes the file there.
File = tuple[Path | None, Callable[[Path], None]]


def deliver(json: Path | None, content: Mapping[str, Any], parts: Sequence[RenderableType], files: Sequence[File] = ()) -> None:
    """Write the files, then print the tables: to stderr if stdout is for the JSON.

    A file that cannot be written keeps neither another nor the tables back, and output that cannot be printed loses no file.

    Args:
        json: for the content as JSON.
        content: for a program.
        parts: tables for a person.
        files: others to write.

    Raises:
        InputError: for every file that cannot be written, in one line.
    """
    in_stdout = json == outputs.STDOUT
    failed = []
    try:
        for path, write in [(None if in_stdout else json, lambda path: outputs.write_json(path, content)), *files]:
            try:
                if path is not None:
                    write(path)
            except InputError as error:
                failed.append(str(error))
    finally:
        tables.show(tables.console(to_stderr=in_stdout), *parts)
        if in_stdout:
            outputs.write_json(json, content)
    if failed:
        raise InputError("; ".join(failed))
