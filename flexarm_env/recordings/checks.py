"""Checks of the arrays and conditions of a recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.recordings.clock import step_back_error
from flexarm_env.recordings.conditions import check_spelling
from flexarm_env.sensors import known_sensors

Floats = NDArray[np.float64]

#: Beyond any reading or command of an arm, in SI.
LARGEST_READING = 1e7
#: A step of time is no longer than so many median steps, since the commands meanwhile are unknown, and the median no shorter
#: than this [s].
LONGEST_STEP, SHORTEST_STEP = 10_000, 1e-7
#: Of a number that is not finite, in a signal (True) and in a column that must be there in every row.
_REMEDIES = {
    True: "correct it, or leave the cell empty if nothing was measured",
    False: "correct it; a replay needs time and reference in every row; only signals and later commands may be absent",
}


def as_vector(name: str, values: ArrayLike) -> Floats:
    """Copy numbers into a vector of floats (n,); NaN where a masked array has a mask.

    Raises:
        InputError: for anything but a vector of real numbers.
    """
    try:
        array = np.array(values)
    except ValueError:  # a ragged list
        array = np.array(None)
    if array.ndim != 1 or array.dtype.kind not in "fiu":
        raise InputError(f"'{name}' is no vector of real numbers; give an array of shape (n,)")
    with np.errstate(over="ignore"):  # a longer float may overflow to infinity, which the checks refuse
        floats = array.astype(np.float64, copy=False)
    floats[np.ma.getmask(values)] = np.nan
    return floats


def check_values(arrays: Mapping[str, Floats], lines: Sequence[int]) -> None:
    """Check that numbers are finite and plausible. A signal alone may have NaN in rows in which it was not measured.

    Args:
        arrays: (n,) by column name, in SI.
        lines: the line of each sample in its file, for messages; empty where there is none.

    Raises:
        InputError: at the first number that is not, and for a signal that was never measured.
    """
    for column, values in arrays.items():
        signal = column in known_sensors()
        bad = np.flatnonzero(np.isinf(values) if signal else ~np.isfinite(values))
        if bad.size:
            raise InputError(f"{_place(bad[0], lines)}, column '{column}': is {values[bad[0]]}; {_REMEDIES[signal]}")
        large = np.flatnonzero(np.abs(values) > LARGEST_READING)
        if large.size and column != "time":
            value = f"{values[large[0]]:g} in SI units, over {LARGEST_READING:g}"
            raise InputError(f"{_place(large[0], lines)}, column '{column}': is {value}; is the unit right?")
        if signal and np.isnan(values).all():
            raise InputError(f"column '{column}': has no reading in any row; leave the column out")


def with_held_command(values: Floats, name: str, lines: Sequence[int]) -> tuple[Floats, str]:
    """Let commands (n,) hold up to the next one, as a drive holds them; NaN where a file has none.

    Args:
        values: in SI.
        name: of the column.
        lines: the line of each sample in its file, for messages; empty where there is none.

    Returns:
        The commands, and a note on them; "" where all are given.

    Raises:
        InputError: for rows before the first command.
    """
    given = np.flatnonzero(~np.isnan(values))
    if len(given) == len(values):
        return values, ""
    if not given.size:
        raise InputError(f"{_place(0, lines)}, column '{name}': is empty, as all of it: there is no command in any row")
    if given[0]:
        first = _place(int(given[0]), lines)
        raise InputError(
            f"{_place(0, lines)}, column '{name}': is empty, and the first command stands in {first}; "
            "a replay needs to know the command from the first row on"
        )
    held = values[given[np.searchsorted(given, np.arange(len(values)), side="right") - 1]]
    return held, f"'{name}' stands in {len(given)} of {len(values)} rows; in the others the last command holds"


def check_time(time: Floats, lines: Sequence[int]) -> None:
    """Check that time (n,) [s] is finite and rises in plausible steps.

    Args:
        time: from 0.
        lines: the line of each sample in its file, for messages; empty where there is none.

    Raises:
        InputError: at the first step of time that does not; `RestartError` where the clock starts again.
    """
    check_values({"time": time}, lines)
    back = np.flatnonzero(np.diff(time) <= 0)
    if back.size:
        raise step_back_error(time, int(back[0]) + 1, _place(int(back[0]) + 1, lines))
    _check_steps(np.diff(time), lines)


def _place(sample: int, lines: Sequence[int]) -> str:
    """Name a sample in a message by its line, else by its number."""
    return f"row {lines[sample]}" if lines else f"sample {sample + 1}"


def _check_steps(steps: Floats, lines: Sequence[int]) -> None:
    """Check steps of time (n - 1,) [s]."""
    if not steps.size:
        return
    usual = float(np.median(steps))
    if usual < SHORTEST_STEP:
        raise InputError(f"column 'time': samples are {usual:.3g} s apart, less than {SHORTEST_STEP:g} s; is the unit right?")
    i = int(steps.argmax())
    if steps[i] > LONGEST_STEP * usual:
        raise InputError(
            f"{_place(i + 1, lines)}, column 'time': {steps[i]:.6g} s after the row before, where samples are {usual:.3g} s"
            " apart; correct it, or cut the recording in two there"
        )


def check_conditions(conditions: Mapping[str, float]) -> None:
    """Check that a header can hold the conditions.

    Raises:
        InputError: for a name that is none or misspells a known one, or a value that is not finite, or a negative payload.
    """
    for name, value in conditions.items():
        if not isinstance(name, str) or not name.isidentifier() or not name.isascii():
            raise InputError(f"condition {name!r}: write its name in letters, digits and _")
        check_spelling(name)
        if not units.is_finite(value) or (name == "payload" and value < 0):
            shown = value if isinstance(value, float) else repr(value)
            raise InputError(f"condition '{name}' is {shown}; write a finite number, for payload one not below 0")
