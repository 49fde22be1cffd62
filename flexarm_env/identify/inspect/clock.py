"""Signals that are late or early against the command, or against the other signals."""

from __future__ import annotations

import numpy as np

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault


def late_signals(evidence: Evidence) -> list[Fault]:
    """Find a lag that all signals have in common, or that of single signals beside others that are in time."""
    numbers, late = evidence.numbers, evidence.late
    off = {
        signal: found.lag
        for signal, found in late.items()
        if abs(found.lag) > numbers.least_lag and found.share > numbers.alike and found.is_within(numbers.least_factor)
    }
    lags = list(off.values())
    if off and len(off) == len(late) and max(lags) - min(lags) < numbers.same_lag:
        return [_fault(evidence, "", float(np.median(lags)))]
    if not any(evidence.agrees(signal) for signal in late):
        return []
    return [_fault(evidence, signal, lag) for signal, lag in off.items() if late[signal].share > numbers.same_shape]


def _fault(evidence: Evidence, signal: str, lag: float) -> Fault:
    recording, time = evidence.recording, f"{abs(lag):.3g} s"
    late = "late" if lag > 0.0 else "early"
    message = f"{signal} is {time} {late} against the model's" if signal else f"all signals are {time} {late} against the command"
    return Fault(
        recording=recording.name,
        source=recording.source,
        signal=signal,
        kind="clock",
        value=lag,
        unit="s",
        message=message,
        hint=f'{signal or "time"} = {{ shift = "{lag:.3g} s" }}',
    )
