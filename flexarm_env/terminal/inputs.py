"""Effects of the user's own, and recordings that fit an arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from flexarm_env.arm import Arm
from flexarm_env.effects import Catalogue, catalogue
from flexarm_env.effects.catalogue import load_effect
from flexarm_env.errors import InputError
from flexarm_env.recordings.arm_columns import layout_of, stands_alone
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.columns import CALIBRATED, ColumnMap
from flexarm_env.recordings.copies import with_copies_noted
from flexarm_env.recordings.episodes import check_episodes
from flexarm_env.recordings.files import files_of
from flexarm_env.recordings.files_read import files_read as files_of_reading
from flexarm_env.recordings.joined import recording_files
from flexarm_env.recordings.recording import Recording, with_distinct_names


def known_effects(specs: Sequence[str]) -> Catalogue:
    """Extend the catalogue by the effects of "FILE.py:Name"."""
    return catalogue().extended(*map(load_effect, specs)) if specs else catalogue()


def read_recordings(arm: Arm, paths: Sequence[Path], columns: Path | None, require_signal: bool = True) -> list[Recording]:
    """Read the recordings in files and folders by a column map, else by the arm's, else by their headers.

    Args:
        arm: that they are of.
        paths: files and folders.
        columns: a column map for all of them; without it the arm's is followed where `layout_of` says so.
        require_signal: whether they must hold a signal that the arm measures; commands alone are enough to be played.

    Raises:
        InputError: for a recording that cannot be read, or that does not fit the arm.
    """
    if columns is not None or not arm.columns:
        recordings = Recording.read_all(paths, columns, calibration(arm), require_signal)
    else:
        layout = _layout(arm)
        files = _recording_files(paths, layout, require_signal)
        distinct = with_distinct_names([one for file in files for one in _read(arm, file, layout, require_signal)])
        recordings = with_copies_noted(distinct)
        check_episodes(len(recordings), layout)
    for recording in recordings:
        _check_fits(arm, recording, require_signal)
    return recordings


def files_read(arm: Arm, paths: Sequence[Path], columns: Path | None, require_signal: bool = True) -> list[Path]:
    """List the files that `read_recordings` reads, beside the arm's and that of the map. Arguments as there."""
    if columns is not None or not arm.columns:
        layout = None if columns is None else load_columns(columns)
        pairs = [(file, layout) for file in recording_files(paths, layout)]
    else:
        own = _layout(arm)
        pairs = [(file, layout_of(file, own, require_signal)[0]) for file in _recording_files(paths, own, require_signal)]
    return [one for file, layout in pairs for one in files_of_reading(file, layout)]


def _layout(arm: Arm) -> ColumnMap:
    """Load the arm's column map."""
    try:
        return load_columns(arm.columns or {})
    except InputError as error:
        raise InputError(f"arm '{arm.name}': {error}") from None


def _recording_files(paths: Sequence[Path], columns: ColumnMap, require_signal: bool) -> list[Path]:
    """List the file of each recording in the order of the paths; where the arm's are in several files, others may stand alone."""
    if not columns.joins:
        return recording_files(paths, columns)
    if not paths:
        return files_of(paths)
    found: list[Path] = []
    for path in paths:
        alone = path.is_file() and stands_alone(path, columns, require_signal)
        files = [path] if alone else [one for one in recording_files([path], columns) if one not in found]
        found += files
    return files_of(found)


def _read(arm: Arm, file: Path, columns: ColumnMap, require_signal: bool) -> list[Recording]:
    """Read the recordings in one file by the arm's column map or by its header."""
    layout, note = layout_of(file, columns, require_signal)
    recordings = Recording.read_each(file, layout, calibration(arm), require_signal)
    return [replace(one, notes=(*one.notes, note)) for one in recordings] if note else recordings


def calibration(arm: Arm) -> dict[str, float]:
    """List the quantity per volt of each signal for which the arm file states one."""
    return {s: table["per_volt"] for s, table in arm.sensors.items() if table["per_volt"] != 0.0 and s in CALIBRATED}


def _check_fits(arm: Arm, recording: Recording, require_signal: bool) -> None:
    if recording.input_kind != arm.input:
        raise InputError(
            f"{recording.source}: holds {recording.input_kind}, but arm '{arm.name}' is driven by {arm.input}; "
            "name another arm with --arm"
        )
    if require_signal and not set(recording.signals) & set(arm.sensors):
        raise InputError(
            f"{recording.source}: has {', '.join(recording.signals)}, of which arm '{arm.name}' measures none; "
            "add a [sensors] table to the arm file"
        )
