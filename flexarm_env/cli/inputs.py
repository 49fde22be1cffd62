"""What the commands read: arms, effects of a person's own, recordings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.effects import Catalogue, catalogue
from flexarm_env.effects.catalogue import load_effect
from flexarm_env.errors import InputError
from flexarm_env.identify.columns import CALIBRATED
from flexarm_env.identify.recording import Recording
from flexarm_env.identify.recording_files import files_of

_ENOUGH = 1 << 16


def known_effects(specs: Sequence[str]) -> Catalogue:
    """Return the catalogue with the effects of "FILE.py:Name"."""
    return catalogue().extended(*map(load_effect, specs)) if specs else catalogue()


def read_recordings(arm: Arm, paths: Sequence[Path], columns: Path | None, measured: bool = True) -> list[Recording]:
    """Return the recordings in files and folders, read by the arm's column map if there is no other.

    Args:
        arm: that they are of.
        paths: files and folders.
        columns: a column map of their own.
        measured: whether they must hold a signal that the arm measures; commands alone are enough to be played.

    Raises:
        InputError: for a recording that cannot be read, or that does not fit the arm.
    """
    layout: Any = columns
    if columns is None and arm.columns and not all(map(_is_native, files_of(paths))):
        layout = arm.columns
    recordings = Recording.read_all(paths, layout, calibration(arm), measured)
    for recording in recordings:
        _check_fits(arm, recording, measured)
    return recordings


def calibration(arm: Arm) -> dict[str, float]:
    """Return the quantity per volt of each signal for which the arm file states one."""
    return {s: table["per_volt"] for s, table in arm.sensors.items() if table["per_volt"] != 0.0 and s in CALIBRATED}


def _is_native(path: Path) -> bool:
    """Tell whether a file has FlexArm's own header, in which case no column map is needed."""
    if not path.is_file():  # a pipe would wait for ever
        return False
    try:
        with path.open("rb") as file:
            lines = file.read(_ENOUGH).decode("utf-8-sig", "replace").splitlines()
    except OSError:
        return False
    header = next((line for line in lines if line.strip() and not line.startswith("#")), "")
    return "time [" in header or "time[" in header


def _check_fits(arm: Arm, recording: Recording, measured: bool) -> None:
    if recording.input_kind != arm.input:
        raise InputError(
            f"{recording.source}: holds {recording.input_kind}, but arm '{arm.name}' is driven by {arm.input}; "
            "name another arm with --arm"
        )
    if measured and not set(recording.signals) & set(arm.sensors):
        raise InputError(
            f"{recording.source}: has {', '.join(recording.signals)}, of which arm '{arm.name}' measures none; "
            "add a [sensors] table to the arm file"
        )
