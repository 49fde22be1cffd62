"""Single wild readings."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, ignore, row_list, shown
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.inspect.wild import split
from flexarm_env.identify.settings import Inspecting


def spike(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find single readings that stand off those before and after them by far more than the signal ever changes."""
    recording = inspected.recording
    found = []
    for signal in recording.signals:
        series = inspected.series(signal, numbers)
        spikes, _ = split(series, numbers)
        if not len(spikes.first):
            continue
        rows = series.rows[spikes.readings()]
        height = float(np.abs(spikes.height).max())
        text = f"has spikes of up to {shown(signal, height)}: {row_list(rows, numbers.most_named)}"
        hint = ignore(recording, signal, rows, numbers.most_ignored)
        found.append(fault(recording, signal, "spike", height, text, hint, rows))
    return found
