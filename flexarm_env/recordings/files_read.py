"""The files from which a recording is read: its own, those of its conditions, and what a data set says of it."""

from __future__ import annotations

from pathlib import Path

from flexarm_env.recordings.columns import ColumnMap
from flexarm_env.recordings.formats.lerobot import info_of
from flexarm_env.recordings.joined import files_of_recording
from flexarm_env.recordings.sidecar import sidecars_of


def files_read(path: Path, columns: ColumnMap | None) -> list[Path]:
    """List the files from which the recording of a file is read.

    Args:
        path: of the recording, that with the command where it is in several files.
        columns: its column map, if there is one.

    Raises:
        InputError: for a file beside it that has neither conditions nor an arm nor a column map.
    """
    info = info_of(path) if columns is not None and not columns.joins else None
    return [*files_of_recording(path, columns), *sidecars_of(path, columns), *([info] if info is not None else [])]
