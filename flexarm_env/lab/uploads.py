"""Recordings uploaded by a browser: bounded in size, and read as files on disk are."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path, PurePosixPath, PureWindowsPath

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.lab.guard import LARGEST_BODY
from flexarm_env.recordings.copies import with_copies_noted
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.inputs import read_recordings

MOST_RECORDINGS = 12
#: Limit on the samples of all recordings together: beyond it replays are too slow to follow a slider.
MOST_SAMPLES = 2_000_000
#: Of a file's name [bytes of UTF-8].
LONGEST_NAME = 255


def read_upload(arm: Arm, name: str, content: bytes, columns: Path | None, present: list[Recording]) -> list[Recording]:
    """Read the recordings in an uploaded file: one, or as many as it has episodes.

    Args:
        arm: recorded in it.
        name: of the file, as sent by the browser.
        content: of the file.
        columns: a column map, if one was named on the command line.
        present: recordings of the session so far.

    Raises:
        InputError: one line that names the file, row and column, or that no temporary file can be written.
    """
    file = plain_name(name)
    if len(present) >= MOST_RECORDINGS:
        raise InputError(f"{file}: {MOST_RECORDINGS} recordings are here already; remove one first")
    if len(content) > LARGEST_BODY:
        raise InputError(f"{file}: is larger than {LARGEST_BODY // 2**20} MB; cut it into shorter recordings")
    try:
        with tempfile.TemporaryDirectory(prefix="flexarm-lab-") as folder:
            path = Path(folder) / file
            path.write_bytes(content)
            found = [replace(one, source=file) for one in _read(arm, path, columns)]
    except OSError as error:
        raise InputError(f"{file}: no temporary file can be written: {error.strerror}; make room, or set TMPDIR") from None
    if len(present) + len(found) > MOST_RECORDINGS:
        raise InputError(f"{file}: has {len(found)} episodes, {MOST_RECORDINGS} recordings are the most; name some in [columns]")
    names = {one.name for one in present}
    for one in found:
        if one.name in names:
            raise InputError(f"{file}: a recording '{one.name}' is here already; remove it or rename the file")
    if sum(map(len, [*present, *found])) > MOST_SAMPLES:
        raise InputError(f"{file}: makes more than {MOST_SAMPLES} samples in all; cut the recordings shorter")
    return with_copies_noted([*present, *found])[len(present) :]


def _read(arm: Arm, path: Path, columns: Path | None) -> list[Recording]:
    """Read the recordings in a temporary file, whose folder no message names."""
    try:
        return read_recordings(arm, [path], columns)
    except InputError as error:
        raise InputError(str(error).replace(f"{path.parent}/", "").replace(str(path.parent / ""), "")) from None


def plain_name(name: str) -> str:
    """Strip folders and unsafe characters from a file's name, and cut it to a length that file systems take."""
    last = PureWindowsPath(PurePosixPath(name).name).name
    text = "".join(c if c.isalnum() or c in "-_. ()" else "_" for c in last).strip(". ")[-80:]
    return text.encode()[-LONGEST_NAME:].decode(errors="ignore") or "recording.csv"
