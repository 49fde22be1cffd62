"""Columns that were sampled at different times, put in one order of time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError
from flexarm_env.parameters import INPUTS

Floats = NDArray[np.float64]

#: Readings nearer to another sample than this share of the shortest usual step are of the same time.
SAME_TIME = 0.01
_HELD = (*INPUTS, "reference")


@dataclass(frozen=True)
class Part:
    """Columns (n,) by name, and their times (n,) [s] on a clock that all parts share."""

    time: Floats
    columns: dict[str, Floats]


def parts_by_lateness(time: Floats, columns: Mapping[str, Floats], lateness: Mapping[str, float]) -> list[Part]:
    """Make a part of the columns that are late by the same time, with earlier times.

    Args:
        time: (n,) [s].
        columns: (n,) each, by name.
        lateness: of each [s].
    """
    found: dict[float, dict[str, Floats]] = {}
    for name, values in columns.items():
        found.setdefault(lateness[name], {})[name] = values
    with np.errstate(over="ignore"):  # an overflow is reported where parts are joined
        return [Part(time - late, those) for late, those in found.items()]


def join(parts: list[Part]) -> dict[str, Floats]:
    """Put the rows of parts in one order of time, without a reading moved, repeated or made up.

    Command and reference hold from one of their samples to the next, as a drive holds them. Where a signal has no sample it is
    NaN: it was not measured then. Samples before the first command or reference and after the last command are left out. Times
    that differ by less than `SAME_TIME` of the shortest usual step are one.

    Args:
        parts: one of them with the command.

    Returns:
        Columns (n,) by name, time among them.

    Raises:
        InputError: for times that do not rise, or that do not overlap with those of the command.

    Examples:
        >>> import numpy as np
        >>> from flexarm_env.recordings.joining import Part, join
        >>> command = Part(np.array([0.0, 1.0, 2.0]), {"current": np.array([5.0, 6.0, 7.0])})
        >>> angle = Part(np.array([0.5, 2.0]), {"arm_angle": np.array([0.1, 0.2])})
        >>> found = join([command, angle])
        >>> found["time"].tolist(), found["current"].tolist(), found["arm_angle"].tolist()
        ([0.0, 0.5, 1.0, 2.0], [5.0, 5.0, 6.0, 7.0], [nan, 0.1, nan, 0.2])
    """
    for part in parts:
        _check_times(part)
    held_parts = [part.time for part in parts if set(_HELD) & set(part.columns)]
    command = next(part.time for part in parts if set(INPUTS) & set(part.columns))
    command = command[command >= max(times[0] for times in held_parts)]
    near = SAME_TIME * min(float(np.median(np.diff(part.time))) for part in parts)
    if len(command) < 2:
        raise InputError("has fewer than two commands after the first reference; files of one recording need one clock")
    time = command
    for part in parts:
        inside = part.time[_inside_run(part.time, command, near)]
        if not inside.size:
            raise InputError(
                f"'{next(iter(part.columns))}' is measured from {part.time[0]:.9g} to {part.time[-1]:.9g} s, the command from"
                f" {command[0]:.9g} to {command[-1]:.9g} s; files of one recording need one clock"
            )
        time = np.sort(np.concatenate([time, inside[_distance(inside, time) > near]]))
    columns = {"time": time}
    for part in parts:
        rows = _inside_run(part.time, command, near)
        places = _nearest(part.time[rows], time)
        held = np.clip(np.searchsorted(part.time, time + near, side="right") - 1, 0, None)
        for name, values in part.columns.items():
            if name in _HELD:
                columns[name] = values[held]
                continue
            columns[name] = np.full(len(time), np.nan)
            columns[name][places] = values[rows]
    return columns


def _inside_run(times: Floats, command: Floats, near: float) -> NDArray[np.bool_]:
    return (times >= command[0] - near) & (times <= command[-1] + near)


def _check_times(part: Part) -> None:
    name = next(iter(part.columns))
    if len(part.time) < 2:
        raise InputError(f"the file of '{name}' has {len(part.time)} samples; it needs at least two")
    with np.errstate(over="ignore", invalid="ignore"):
        steps = np.diff(part.time)
    leap = np.flatnonzero(~np.isfinite(steps))
    if leap.size:
        raise InputError(f"the time of '{name}' leaps beyond any number after its sample {leap[0] + 1}; correct it")
    back = np.flatnonzero(~(steps > 0))
    if back.size:
        raise InputError(
            f"the time of '{name}' does not rise after its sample {back[0] + 1}, {part.time[back[0]]:.9g} s; correct it"
        )


def _nearest(times: Floats, among: Floats) -> NDArray[np.intp]:
    """Find for each time the index of the nearest of others that rise."""
    after = np.clip(np.searchsorted(among, times), 1, len(among) - 1)
    return np.where(times - among[after - 1] <= among[after] - times, after - 1, after)


def _distance(times: Floats, among: Floats) -> Floats:
    return np.abs(times - among[_nearest(times, among)])
