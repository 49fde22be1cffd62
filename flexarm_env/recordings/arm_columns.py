"""By which layout a recording is read: the arm's column map, or the file's own header."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from flexarm_env.errors import InputError
from flexarm_env.parameters import INPUTS
from flexarm_env.recordings.columns import ColumnMap, Source, check_names, native_sources
from flexarm_env.recordings.formats.catalogue import format_of
from flexarm_env.sensors import known_sensors


def layout_of(path: Path, columns: ColumnMap, require_signal: bool = True) -> tuple[ColumnMap | None, str]:
    """Choose between an arm's column map and the header of a file.

    The map is followed unless the header is FlexArm's own. It is followed there, too, where the file has every column that
    it names. A map of column numbers must agree with such a header in names and units, because any file has those numbers.
    A map that names no places refines the header, and one of several files has the place of each column.

    Args:
        path: the file.
        columns: the arm's map.
        require_signal: whether the file must hold a signal; commands alone are always read by a header of FlexArm's own.

    Returns:
        The map, or None to follow the header; and a note where they differ, else "".
    """
    own, texts = _own_header(path)
    if columns.joins:
        alone = stands_alone(path, columns, require_signal)
        return (None, "read by its own header; the arm's [columns] are of several files") if alone else (columns, "")
    if not own or ("time" not in own and not columns.refines):
        return columns, ""
    if columns.refines:
        return _refinement(columns, own, require_signal)
    by_number = all(source.key == "index" for source in columns.sources.values())
    found = _found(columns, texts)
    differing = [name for name, source in found.items() if own.get(name) != source]
    if len(found) == len(columns.sources):
        if not by_number or all(_agree(own.get(name), source) for name, source in found.items()):
            return columns, _note("the arm's [columns]", "its own header differs", differing)
        return None, _note("its own header", "the arm's [columns] differ", differing)
    if by_number:
        differing = [name for name in columns.sources if name not in found or own.get(name) != found[name]]
        return None, _note("its own header", "the arm's [columns] differ", differing)
    if not differing:
        return None, ""
    return (columns, "") if require_signal else (None, _note("its own header", "the arm's [columns] differ", differing))


def stands_alone(path: Path, columns: ColumnMap, require_signal: bool = True) -> bool:
    """Whether a file is a recording of FlexArm's own, and not one of the several files of an arm's map.

    Args:
        path: the file.
        columns: the arm's map of several files.
        require_signal: whether a recording must hold a signal.
    """
    own, texts = _own_header(path)
    whole = "time" in own and set(INPUTS) & set(own) and (not require_signal or set(known_sensors()) & set(own))
    command = columns.sources[check_names(tuple(columns.sources))]
    mapped = {name: source for name, source in columns.sources.items() if source.file in ("", command.file)}
    return bool(whole) and len(_found(replace(columns, sources=mapped), texts)) < len(mapped)


def _refinement(columns: ColumnMap, own: dict[str, Source], require_signal: bool) -> tuple[ColumnMap, str]:
    """Limit a map that refines a header to the columns that commands have; recordings must have all."""
    kept = {name: source for name, source in columns.sources.items() if require_signal or name in own}
    changed = [name for name, source in kept.items() if source.key == "header"]
    return replace(columns, sources=kept), _note("its own header", "the arm's [columns] refine it", changed)


def _own_header(path: Path) -> tuple[dict[str, Source], list[str]]:
    """Read the sources that a header of FlexArm's own states, and its cells; nothing where there is none."""
    if not path.is_file():  # a pipe would wait for ever
        return {}, []
    read_header = format_of(path).header
    if read_header is None:
        return {}, []
    try:
        with path.open("rb") as file:
            texts = read_header(file)
        return native_sources(texts), texts
    except (OSError, InputError):
        return {}, []


def _found(columns: ColumnMap, texts: list[str]) -> dict[str, Source]:
    """Select the sources of a map that lie in a header of FlexArm's own, with numbers in the place of texts."""
    if columns.delimiter != "," or columns.header_prefix:
        return {}
    numbers = {text.strip(): number for number, text in enumerate(texts)}
    found = {}
    for name, source in columns.sources.items():
        place = numbers.get(str(source.place).strip()) if source.key == "column" else source.place
        if isinstance(place, int) and place < len(texts):
            found[name] = replace(source, place=place, key="index")
    return found


def _agree(own: Source | None, mapped: Source) -> bool:
    return own is not None and (own.place, own.unit) == (mapped.place, mapped.unit)


def _note(followed: str, other: str, differing: Iterable[str]) -> str:
    names = ", ".join(differing)
    return f"read by {followed}; {other} in {names}" if names else ""
