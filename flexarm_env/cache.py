"""The folder of generated modules and of their machine code: where it is, and how damage in it is found.

Machine code is executed as it is read. So the digests of all files of a module lie beside them, and a file that is not as it
was written is made anew.
"""

from __future__ import annotations

import atexit
import hashlib
import logging
import os
import shutil
import tempfile
from functools import lru_cache
from pathlib import Path

from flexarm_env.errors import InputError
from flexarm_env.files import write_whole

VARIABLE = "FLEXARM_CACHE"
REMEDY = f"set {VARIABLE} to a folder that can be written, with room"
#: Room [bytes] that the machine code of one module is given: the largest of the shipped arms' takes 20 MB.
ROOM = 32 * 2**20
#: Written at once to find out whether there is room [bytes].
PIECE = 2**20
#: Of a module, of what Python compiles of it, and of numba's indices and machine code.
SUFFIXES = (".py", ".pyc", ".nbi", ".nbc")


def cache_folder(name: str) -> Path:
    """Locate the folder of the compiled kernels: $FLEXARM_CACHE, or flexarm in the user's cache.

    Where it cannot be written, or has no room for what is not compiled yet, it is a temporary one, for this process and those
    that it starts.

    Args:
        name: of a module.

    Raises:
        InputError: where the temporary one has no room, either.
    """
    wanted = _wanted()
    if wanted is None or not _is_writable(wanted, 0):
        return _temporary(str(wanted or "the user's cache folder"), "cannot be written")
    if is_compiled(wanted, name) or _is_writable(wanted, ROOM):
        return wanted
    return _temporary(str(wanted), f"has no room for {ROOM >> 20} MB of compiled kernels")


def is_compiled(folder: Path, name: str) -> bool:
    """Whether there is machine code of a module."""
    return any((folder / "__pycache__").glob(f"{name}*.nbi"))


def _wanted() -> Path | None:
    given, cache = os.environ.get(VARIABLE), os.environ.get("XDG_CACHE_HOME")
    if given or cache:
        return Path(given) if given else Path(str(cache)) / "flexarm"
    try:
        return Path.home() / ".cache" / "flexarm"
    except RuntimeError:  # no HOME, and no user of that number
        return None


def _is_writable(folder: Path, size: int) -> bool:
    """Whether a file of a size [bytes] can be written: a quota and a limit on files are met in no other way."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder, buffering=0) as file:
            piece = os.urandom(min(size, PIECE))  # some file systems keep zeros in no room at all
            return all(file.write(piece) == PIECE for _ in range(size // PIECE))
    except OSError:
        return False


@lru_cache(maxsize=8)
def _temporary(wanted: str, why: str) -> Path:
    """Make a folder that only this user can read, and that is removed when this process ends."""
    try:
        folder = Path(tempfile.mkdtemp(prefix="flexarm-"))
    except OSError as error:
        raise InputError(f"{wanted} {why}, nor can a temporary folder: {error.strerror}; {REMEDY}") from None
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    if not _is_writable(folder, ROOM):
        raise InputError(f"{wanted} {why}, and {folder.parent} has no room for them, either; {REMEDY}")
    os.environ[VARIABLE] = str(folder)  # processes that this one starts need not compile again
    logging.getLogger(__name__).warning("%s %s: what is compiled is lost with this process; %s", wanted, why, REMEDY)
    return folder


def remove_damaged(folder: Path, name: str) -> None:
    """Remove the files of a module that are not as their digests say; what is removed is made anew."""
    try:
        listed = dict(line.split("  ", 1)[::-1] for line in _list(folder, name).read_text(encoding="utf-8").splitlines())
    except FileNotFoundError:
        return
    except (ValueError, OSError):
        forget(folder, name)
        return
    for path in _files(folder, name):
        digest = listed.get(str(path.relative_to(folder)))
        if digest is not None and digest != _digest(path):
            path.unlink(missing_ok=True)


def record(folder: Path, name: str) -> None:
    """Write the digests of a module's files, where they can be written."""
    lines = [f"{_digest(path)}  {path.relative_to(folder)}\n" for path in _files(folder, name)]
    try:
        write_whole(_list(folder, name), "".join(lines))
    except InputError:
        return


def forget(folder: Path, name: str) -> None:
    """Remove all files of a module."""
    for path in (_list(folder, name), *_files(folder, name)):
        path.unlink(missing_ok=True)


def _list(folder: Path, name: str) -> Path:
    return folder / f"{name}.sha256"


def _files(folder: Path, name: str) -> list[Path]:
    """List the module and what was compiled of it."""
    every = (folder / f"{name}.py", *sorted((folder / "__pycache__").glob(f"{name}.*")))
    return [path for path in every if path.suffix in SUFFIXES and path.is_file()]


def _digest(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:  # another process has removed it
        return ""
