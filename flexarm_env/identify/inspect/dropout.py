"""Readings that were lost, and stand in the file as zeros or as another value that is none."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, ignore, row_list, shown
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.inspect.wild import split
from flexarm_env.identify.settings import Inspecting


def dropout(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find readings that stand off the signal and are equal to each other or 0."""
    recording = inspected.recording
    found = []
    for signal in recording.signals:
        series = inspected.series(signal, numbers)
        _, lost = split(series, numbers)
        if not len(lost.first):
            continue
        kept, counts = np.unique(series.values[lost.readings()], return_counts=True)
        value = float(kept[counts.argmax()])
        rows = series.rows[lost.readings()]
        text = f"drops out: it is {shown(signal, value)} in {row_list(rows, numbers.most_named)}"
        hint = ignore(recording, signal, rows, numbers.most_ignored)
        found.append(fault(recording, signal, "dropout", value, text, hint, rows))
    return found
