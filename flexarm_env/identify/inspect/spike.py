"""Single wild readings that no jump of the command explains."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, ignore, row_list, shown
from flexarm_env.identify.inspect.series import Floats, Inspected, Integers
from flexarm_env.identify.inspect.wild import split
from flexarm_env.identify.settings import Inspecting


def spike(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find single readings that stand off those before and after them by far more than the signal ever changes.

    A light motor on soft gears leaps where a controller answers a step: readings of the first samples after it are its motion.
    """
    recording = inspected.recording
    leaps = after_jumps(recording.command, numbers)
    found = []
    for signal in recording.signals:
        series = inspected.series(signal, numbers)
        spikes, _ = split(series, numbers)
        spikes = spikes.where(~np.isin(series.rows[spikes.first], leaps))
        if not len(spikes.first):
            continue
        rows = series.rows[spikes.readings()]
        height = float(np.abs(spikes.height).max())
        text = f"has spikes of up to {shown(signal, height)}: {row_list(rows, numbers.most_named)}"
        hint = ignore(recording, signal, rows, numbers.most_ignored)
        found.append(fault(recording, signal, "spike", height, text, hint, rows))
    return found


def after_jumps(command: Floats, numbers: Inspecting) -> Integers:
    """List the samples soon after the command changed by far more than it usually does; none at the change itself.

    A controller answers a wild reading in the same sample, at the earliest.
    """
    changes = np.abs(np.diff(command, prepend=0.0))
    jumps = np.flatnonzero(changes > numbers.wild * float(np.quantile(changes, numbers.usual)))
    return np.unique(np.add.outer(jumps, np.arange(1, 1 + numbers.answered))).astype(np.int64)
