"""One recording in several files, one signal each: which files belong together."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import UNITS, ColumnMap, Source, check_names, lateness_of, part_names, quantity_of
from flexarm_env.recordings.files import PathLike, files_of, read_bytes
from flexarm_env.recordings.formats.catalogue import format_of
from flexarm_env.recordings.joining import Part, join, parts_by_lateness
from flexarm_env.recordings.messages import file_error, quoted
from flexarm_env.recordings.table import Table

Floats = NDArray[np.float64]


def recording_files(paths: Iterable[PathLike], columns: ColumnMap | None = None) -> list[Path]:
    """List the file of each recording in files and folders; that with the command, where it is in several.

    Args:
        paths: as given.
        columns: the map that names the other files; without one each file is a recording.

    Raises:
        InputError: as `files_of`, and for a file that belongs to no recording of the map.
    """
    if columns is None or not columns.joins:
        return files_of(paths)
    found: list[Path] = []
    for path in map(Path, paths):
        inside = _inside(path, columns) if path.is_dir() else [path]
        found += [file for file in (_command_file(one, columns) for one in inside) if file not in found]
    return files_of(dict.fromkeys(found))


def run_name(columns: ColumnMap, path: Path) -> str:
    """Find the text for which the "*" of the files' names stands in the recording of a file, "" if for none."""
    pattern = _command_pattern(columns)
    return path.stem if pattern == "*" else _star(pattern, path.name)


def recording_name(path: Path, columns: ColumnMap | None) -> str:
    """Name the recording of a file: by its run where it is in several files, by its folder where each folder is one run.

    Args:
        path: the file, that with the command where there are several.
        columns: its column map, if there is one.
    """
    if columns is None or not columns.joins:
        return path.stem
    return run_name(columns, path) or path.resolve().parent.name


def files_of_recording(path: Path, columns: ColumnMap | None) -> list[Path]:
    """List the files that hold a recording, that with the command first. Arguments as `recording_name`."""
    if columns is None or not columns.joins:
        return [path]
    return list(dict.fromkeys(_part_file(path, pattern, columns) for pattern in _by_file(columns)))


def _part_file(path: Path, pattern: str, columns: ColumnMap) -> Path:
    """Find the file of a pattern that belongs to the file with the command."""
    if pattern in ("", _command_pattern(columns)):
        return path
    return path.with_name(pattern.replace("*", run_name(columns, path)))


def _command_pattern(columns: ColumnMap) -> str:
    """Find the name of the file that has the command; "*" where it has no name of its own."""
    return columns.sources[check_names(tuple(columns.sources))].file or "*"


def _other_patterns(columns: ColumnMap) -> list[str]:
    """List the names of the other files."""
    return sorted({source.file for source in columns.sources.values()} - {"", _command_pattern(columns)})


def _inside(folder: Path, columns: ColumnMap) -> list[Path]:
    """List the files with commands in a folder."""
    pattern, others = _command_pattern(columns), _other_patterns(columns)
    files = files_of([folder]) if pattern == "*" else sorted(file for file in folder.glob("*") if _fits(pattern, file.name))
    found = [file for file in files if not any(_fits(other, file.name) for other in others)]
    if not found:
        raise file_error(folder, f"has no file {quoted(pattern)}, which [columns] names; name another folder, or correct it")
    return found


def _command_file(file: Path, columns: ColumnMap) -> Path:
    """Find the file with the command that belongs to a file."""
    pattern, others = _command_pattern(columns), _other_patterns(columns)
    other = next((one for one in others if _fits(one, file.name)), None)
    if other is None:
        if not _fits(pattern, file.name):
            names = ", ".join(map(quoted, (pattern, *others)))
            raise file_error(file, f"is none of the files that [columns] names, {names}; name one of those")
        return file
    name = _star(other, file.name)
    if pattern != "*":
        return file.with_name(pattern.replace("*", name))
    twins = [one for one in sorted(file.parent.glob("*")) if one.stem == name]
    if len(twins) != 1:
        raise file_error(
            file, f"belongs to a recording '{name}', of which there are {len(twins)} files; name that with the command"
        )
    return twins[0]


def _fits(pattern: str, name: str) -> bool:
    prefix, star, suffix = pattern.partition("*")
    whole = len(name) >= len(prefix) + len(suffix) and name.startswith(prefix) and name.endswith(suffix)
    return whole if star else name == pattern


def _star(pattern: str, name: str) -> str:
    prefix, star, suffix = pattern.partition("*")
    return name[len(prefix) : len(name) - len(suffix)] if star else ""


def read_joined(path: Path, columns: ColumnMap, gains: Mapping[str, float]) -> tuple[Table, str]:
    """Read the recording of a file with a command, and of the other files that belong to it.

    Signals are corrected as their entries say, on the times of their own files.

    Args:
        path: the file with the command.
        columns: the map that names the others.
        gains: SI per volt, by signal.

    Returns:
        The table in SI, and the checksum of the files.

    Raises:
        InputError: for a file that is absent or cannot be read, for conditions of two files that differ, and for times that do
            not overlap.
    """
    parts: list[Part] = []
    conditions: dict[str, float] = {}
    unread: dict[str, str] = {}
    notes: list[str] = []
    checksum = hashlib.sha256()
    clock: float | None = None
    for pattern, sources in _by_file(columns).items():
        file = _part_file(path, pattern, columns)
        try:
            content = read_bytes(file)
            beside = columns.conditions if file == path else {}
            table = format_of(file).table(content, replace(columns, sources=sources, conditions=beside))
            arrays = table.in_si(gains)
            first = table.first_time(gains)
            clock = first if clock is None else clock
            with np.errstate(over="ignore", invalid="ignore"):  # an overflow is reported where parts are joined
                time = (first - clock) + arrays.pop("time")
            _check_conditions(table.conditions, conditions)
        except InputError as error:
            raise error if file == path else InputError(f"{file.name}: {error}") from None
        checksum.update(content)
        conditions |= table.conditions
        unread |= table.unread
        notes += table.notes
        parts += _corrected(time, arrays, sources)
    plain = {quantity: Source(quantity, UNITS[quantity]) for quantity in map(quantity_of, columns.sources)}
    return Table(join(parts), plain, conditions, unread=unread, notes=tuple(notes)), checksum.hexdigest()


def _check_conditions(found: Mapping[str, float], others: Mapping[str, float]) -> None:
    for name, value in found.items():
        if others.get(name, value) != value:
            raise InputError(f"condition '{name}' is {value:g}, but {others[name]:g} in another of its files; correct one")


def _corrected(time: Floats, arrays: Mapping[str, Floats], sources: Mapping[str, Source]) -> list[Part]:
    """Correct the columns of a file; those that are late by another time are parts of their own, with earlier times.

    Args:
        time: (n,) [s], from the first command.
        arrays: (n,) in SI, by name.
        sources: their entries, with those of time.
    """
    plain = {name: replace(sources[name].corrections, shift=0.0) for name in arrays}
    columns = {name: plain[name].apply(time, values) for name, values in arrays.items()}
    return parts_by_lateness(time, columns, {name: lateness_of(name, sources) for name in arrays})


def _by_file(columns: ColumnMap) -> dict[str, dict[str, Source]]:
    """Group the sources by file, the command's first, each with its time."""
    command = columns.sources[check_names(tuple(columns.sources))]
    common = {name: source for name, source in columns.sources.items() if quantity_of(name) == "time"}
    groups: dict[str, dict[str, Source]] = {command.file: {}}
    for name, source in columns.sources.items():
        if name not in common:
            own = dict(zip(part_names("time", len(source.time)), source.time, strict=True)) if source.time else common
            groups.setdefault(source.file, {}).update({**own, name: source})
    return groups
