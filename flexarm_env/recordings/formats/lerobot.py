"""LeRobot data sets: a folder of Parquet files, and beside them `meta/info.json` with the rate and the names of elements."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.recordings.columns import ColumnMap, Source
from flexarm_env.recordings.messages import quoted

#: Columns of such a file: number of the recording, of the row in it, and its time from its start [s].
EPISODE, FRAME, STAMP = "episode_index", "frame_index", "timestamp"

_INFO = Path("meta/info.json")
_LARGEST_INFO = 16 * 2**20
#: Folders from a file up to its data set: data/chunk-000/file-000.parquet.
_DEPTH = 3
_NAMED = re.compile(r"([^\[\]]+)\[([^\[\]]*[^\[\]\d][^\[\]]*)\]")
#: Median step of time over that of the stated rate, less 1, beyond which the two are not of one recording.
_RATE_DIFFERS = 0.01


def data_files(folder: Path) -> list[Path]:
    """List the files of recordings in the folder of a data set; none for another folder."""
    return sorted(folder.glob("data/*/*.parquet")) if (folder / _INFO).is_file() else []


def with_info(path: Path, columns: ColumnMap) -> ColumnMap:
    """Complete the column map of a Parquet file by the `meta/info.json` of its data set, if it has one.

    Args:
        path: the file.
        columns: its map, in which elements of lists may have names, such as "observation.state[shoulder_pan.pos]".

    Returns:
        The map with numbers of elements, and the stated rate.

    Raises:
        InputError: for an info that is damaged, and for a name that it does not have.
    """
    if path.suffix.lower() != ".parquet":
        return columns
    place = info_of(path)
    info = _info(place) if place is not None else None
    rate = _rate(info.get("fps", 0)) if info else 0.0
    features = info.get("features", {}) if info else None
    sources = {name: _numbered(name, source, features) for name, source in columns.sources.items()}
    conditions = {name: _numbered(name, source, features) for name, source in columns.conditions.items()}
    return replace(columns, sources=sources, conditions=conditions, frame_rate=rate)


def exact_times(stamps: NDArray[np.float64], frames: NDArray[np.float64], rate: float) -> NDArray[np.float64]:
    """Undo the rounding of stamps to single precision, where they count frames at a rate.

    Args:
        stamps: (n,) [s].
        frames: (n,) numbers of the rows in their recording.
        rate: frames per second [Hz].

    Raises:
        InputError: for stamps of another rate.
    """
    steps = np.diff(stamps)[np.diff(frames) == 1]
    step = float(np.median(steps)) if steps.size else 1.0 / rate
    if not abs(step * rate - 1.0) <= _RATE_DIFFERS:
        raise InputError(
            f"column 'time': {STAMP} goes on by {step:.3g} s a row, but {_INFO} states {rate:g} frames per second; "
            "correct the one that is wrong, or write time = { rate = … }"
        )
    exact = frames / rate
    rounding = float(np.finfo(np.float32).eps) * np.abs(stamps).max(initial=0.0)
    return exact if (np.abs(stamps - exact) <= rounding).all() else stamps


def info_of(path: Path) -> Path | None:
    """Find the info of the data set that a Parquet file is of; None for a file of none."""
    if path.suffix.lower() != ".parquet" or len(path.resolve().parents) < _DEPTH:
        return None
    place = path.resolve().parents[_DEPTH - 1] / _INFO
    return place if place.is_file() else None


def _info(place: Path) -> Mapping[str, Any]:
    """Read the info of a data set."""
    try:
        content = place.read_bytes() if place.stat().st_size <= _LARGEST_INFO else b""
        info = json.loads(content)
    except (OSError, ValueError, RecursionError):
        raise InputError(f"{_INFO} beside it is damaged or no JSON; mend it, or move the file out of the data set") from None
    if not isinstance(info, dict) or not isinstance(info.get("features", {}), dict):
        raise InputError(f"{_INFO} beside it has no table of features; mend it, or move the file out of the data set")
    return info


def _rate(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < float("inf"):
        raise InputError(f"{_INFO}: fps is {quoted(str(value))}; write the frames per second")
    return float(value)


def _numbered(name: str, source: Source, features: Mapping[str, Any] | None) -> Source:
    """Put the number of an element in the place of its name."""
    match = _NAMED.fullmatch(source.place) if source.key == "column" and isinstance(source.place, str) else None
    if match is None or (features is not None and source.place in features):
        return source
    column, element = match.groups()
    if features is None:
        raise InputError(
            f"column '{name}': {quoted(str(source.place))} has a name of an element, but no {_INFO} beside the data "
            "states names; write its number, counted from 0"
        )
    if column not in features:
        others = did_you_mean(column, features) if features else ""
        raise InputError(f"column '{name}': no feature {quoted(column)} in {_INFO}{others}")
    names = _names(features[column])
    if not names:
        raise InputError(f"column '{name}': {_INFO} names no elements of {quoted(column)}; write a number, counted from 0")
    if names.count(element) != 1:
        here = f"has {quoted(element)} {names.count(element)} times" if element in names else f"has no {quoted(element)}"
        raise InputError(f"column '{name}': {quoted(column)} {here} in {_INFO}{did_you_mean(element, names)}")
    return replace(source, place=f"{column}[{names.index(element)}]")


def _names(feature: Any) -> list[str]:
    """List the names of a feature's elements, in a list or in a table by kind; none where they are not one for each."""
    shape = feature.get("shape") if isinstance(feature, dict) else None
    names = list(_texts(feature.get("names"))) if isinstance(feature, dict) else []
    return names if isinstance(shape, list) and len(shape) == 1 and shape[0] == len(names) else []


def _texts(names: Any) -> Iterator[str]:
    if isinstance(names, str):
        yield names
    elif isinstance(names, list | dict):
        for part in names.values() if isinstance(names, dict) else names:
            yield from _texts(part)
