"""Signals that are late or early against the command, or against the other signals."""

from __future__ import annotations

import numpy as np

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault
from flexarm_env.identify.inspect.series import HUB


def late_signals(evidence: Evidence) -> list[Fault]:
    """Find a lag that all signals have in common, or that of single signals beside others that are in time."""
    off = {signal: found.lag for signal, found in evidence.late.items() if _is_late(evidence, signal)}
    lags = list(off.values())
    if off and len(off) == len(evidence.late) and max(lags) - min(lags) < evidence.numbers.same_lag:
        return [_fault(evidence, "", float(np.median(lags)))]
    return _hub_out_of_step(evidence) or [
        _fault(evidence, signal, lag) for signal, lag in off.items() if _others_are_in_time(evidence, signal)
    ]


def _hub_out_of_step(evidence: Evidence) -> list[Fault]:
    """Find a lag between angle and speed, and blame the one that is less like the model."""
    if evidence.hub is None or evidence.hub_in_step:
        return []
    numbers, found = evidence.numbers, evidence.run.hub_late(evidence.gear_ratio)
    if found.share < numbers.alike or abs(found.lag) < numbers.least_lag or not found.is_within(numbers.least_factor):
        return []
    angle, speed = (evidence.at_once[signal].share for signal in HUB)
    return [_fault(evidence, HUB[0], found.lag) if angle < speed else _fault(evidence, HUB[1], -found.lag)]


def _is_late(evidence: Evidence, signal: str) -> bool:
    """Whether a signal is like the model's at a lag, and much less so without."""
    numbers, late = evidence.numbers, evidence.late[signal]
    exact = evidence.run.leaves_noise(signal, late)
    least, share = (numbers.least_lag, numbers.similar) if exact else (numbers.sure_lag, numbers.alike)
    is_like = late.share > share and late.is_within(numbers.plausible)
    return is_like and abs(late.lag) > least and evidence.is_like_model_later(signal)


def _others_are_in_time(evidence: Evidence, signal: str) -> bool:
    """Whether a signal beside one is like the model's without a lag, and it is late against the hub's other signal."""
    numbers = evidence.numbers
    if signal in HUB and evidence.hub is not None and evidence.hub.share > numbers.same_shape:
        return False
    beside = [other for name, other in evidence.late.items() if name != signal]
    return any(other.share > numbers.similar and abs(other.lag) < numbers.same_lag for other in beside)


def _fault(evidence: Evidence, signal: str, lag: float) -> Fault:
    time, late = f"{abs(lag):.3g} s", "late" if lag > 0.0 else "early"
    text = f"is {time} {late} against the model's" if signal else f"all signals are {time} {late} against the command"
    return fault(evidence.recording, signal, "clock", lag, text, f'{signal or "time"} = {{ shift = "{lag:.3g} s" }}')
