"""A noisy reading that stands still for a while: the last value in place of those that were lost."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, ignore, row_list, shown
from flexarm_env.identify.inspect.series import Inspected, Integers, Series, partners
from flexarm_env.identify.settings import Inspecting


def frozen(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find stretches of equal readings that are longer than chance allows a signal that flickers, while others go on."""
    recording = inspected.recording
    found = []
    every = {signal: inspected.series(signal, numbers) for signal in recording.signals}
    for signal, series in every.items():
        readings = still(series, numbers) if series.flicker > numbers.flickers else np.zeros(0, dtype=np.int64)
        if not readings.size or all(one.stands_still(series.rows[readings], numbers) for one in partners(signal, every)):
            continue
        rows, value = np.sort(series.rows[readings]), float(series.values[readings[0]])
        text = f"stands still at {shown(signal, value)} in {row_list(rows, numbers.most_named)}"
        hint = ignore(recording, signal, rows, numbers.most_ignored)
        found.append(fault(recording, signal, "dropout", value, text, hint, rows))
    return found


def still(series: Series, numbers: Inspecting) -> Integers:
    """List the readings of stretches that stand still, the longest stretch first."""
    starts, lengths = series.runs()
    longest = int(lengths.max())
    within = np.zeros(len(series), dtype=bool)
    within[starts[lengths.argmax()] : starts[lengths.argmax()] + longest] = True
    usual = max(series.most_repeats(~within, numbers), series.repeats_at_rest(numbers))
    least = 1 + (numbers.evidence + math.log(len(series))) / -math.log(usual) if usual < 1 else math.inf
    chosen = np.flatnonzero(lengths > least)
    chosen = chosen[np.argsort(-lengths[chosen], kind="stable")]
    parts = [np.arange(starts[k], starts[k] + lengths[k]) for k in chosen]
    return np.concatenate(parts) if parts else np.zeros(0, dtype=np.int64)
