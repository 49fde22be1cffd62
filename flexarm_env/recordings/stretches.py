"""The stretches of a run between the changes of its conditions, such as of a drive that is switched off."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError

if TYPE_CHECKING:
    from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]

#: Stretches of one run: a condition that changes more often is a signal.
MOST_STRETCHES = 100


def held(numbers: Floats) -> Floats:
    """Let numbers (n,) hold up to the next one, and the first from the start; NaN where a file has none.

    Examples:
        >>> import numpy as np
        >>> from flexarm_env.recordings.stretches import held
        >>> held(np.array([np.nan, 1.0, np.nan, 0.0, np.nan])).tolist()
        [1.0, 1.0, 1.0, 0.0, 0.0]
    """
    known = np.flatnonzero(~np.isnan(numbers))
    last = np.searchsorted(known, np.arange(len(numbers)), side="right") - 1
    return numbers[known[np.maximum(last, 0)]]


def stretches_of(recording: Recording, changing: Mapping[str, Sequence[float]]) -> list[Recording]:
    """Cut a recording where a condition changes; a note on each part says where.

    Args:
        recording: of n samples, the whole run.
        changing: n numbers of each condition that changes, in SI.

    Raises:
        InputError: for conditions that change too often, and for a run without a part of two samples and a reading.
    """
    if not changing:
        return [recording]
    differ = [np.flatnonzero(np.diff(np.asarray(numbers, dtype=np.float64))) + 1 for numbers in changing.values()]
    starts = np.unique(np.concatenate([[0], *differ])).tolist()
    listed = " and ".join(f"'{name}'" for name in changing)
    if len(starts) > MOST_STRETCHES:
        raise InputError(
            f"condition {listed} makes {len(starts)} stretches of one run, the limit is {MOST_STRETCHES}; write mean = true"
        )
    found = []
    for number, (start, stop) in enumerate(zip(starts, [*starts[1:], len(recording)], strict=True), 1):
        is_read = not recording.signals or any(np.isfinite(values[start:stop]).any() for values in recording.signals.values())
        if stop - start < 2 or not is_read:
            continue
        part = recording.part(float(recording.time[start]), float(recording.time[stop]) if stop < len(recording) else None)
        conditions = {name: numbers[start] for name, numbers in changing.items()}
        values = " and ".join(f"{name} = {value:g}" for name, value in conditions.items())
        last = recording.time[min(stop, len(recording) - 1)]
        note = f"part {number} of {len(starts)}, {recording.time[start]:.4g} to {last:.4g} s of the run, in which {values}"
        named = f"{recording.name} part {number}"
        found.append(replace(part, name=named, conditions=part.conditions | conditions, notes=(*part.notes, note)))
    if not found:
        raise InputError(f"condition {listed} changes at every sample, so that no part has two of them; write mean = true")
    return found
