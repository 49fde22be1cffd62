"""Signals that are late or early against the command, or against the other signals."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.hub_lag import beats_play, hub_lag
from flexarm_env.identify.inspect.report import fault
from flexarm_env.identify.inspect.series import HUB
from flexarm_env.identify.settings import MotionFaults


def late_signals(evidence: Evidence) -> list[Fault]:
    """Find a lag that all signals have in common, or that of single signals beside others that are in time."""
    off = {signal: found.lag for signal, found in evidence.late.items() if _is_late(evidence, signal)}
    if len(off) == len(evidence.late) or _are_late_together(evidence):
        lags = [found.lag for found in evidence.late.values()]
        if max(lags) - min(lags) < evidence.numbers.same_lag:
            return [clock_fault(evidence, "", float(np.median(lags)))]
    found = _hub_out_of_step(evidence) or [
        clock_fault(evidence, signal, lag) for signal, lag in off.items() if _others_are_in_time(evidence, signal)
    ]
    return [one for one in found if not _is_filtered(evidence, one)]


def _hub_out_of_step(evidence: Evidence) -> list[Fault]:
    """Find a lag between angle and speed, and blame the one that is less like the model."""
    if evidence.hub is None:
        return []
    small = hub_lag(evidence.recording, evidence.gear_ratio, evidence.numbers)
    if small.lag:
        return [clock_fault(evidence, HUB[0], small.lag, HUB[1])]
    if evidence.hub_in_step:
        return []
    numbers, found = evidence.numbers, evidence.run.hub_late(evidence.gear_ratio)
    if found.share < numbers.alike or abs(found.lag) < numbers.least_lag or not found.is_within(numbers.least_factor):
        return []
    if not beats_play(evidence.recording, evidence.gear_ratio, found.lag, numbers):
        return []
    angle, speed = (evidence.at_once[signal].share for signal in HUB)
    return [clock_fault(evidence, HUB[0], found.lag) if angle < speed else clock_fault(evidence, HUB[1], -found.lag)]


def _are_late_together(evidence: Evidence) -> bool:
    """Whether one of several signals agrees with the model at a lag, and all others move as the model does at a lag.

    Where these lags are one, no effect and no constants explain them: those change the phase of each signal by another time.
    """
    numbers, late = evidence.numbers, evidence.late
    similar = all(found.share > numbers.similar and found.is_within(numbers.plausible) for found in late.values())
    later = all(abs(late[signal].lag) > numbers.least_lag and evidence.is_like_model_later(signal) for signal in late)
    return len(late) > 1 and similar and later and max(found.share for found in late.values()) > numbers.alike


def _is_late(evidence: Evidence, signal: str) -> bool:
    """Whether a signal is like the model's at a lag, and much less so without."""
    numbers, late = evidence.numbers, evidence.late[signal]
    exact = evidence.run.leaves_noise(signal, late)
    least, share = (numbers.least_lag, numbers.similar) if exact else (numbers.sure_lag, numbers.alike)
    is_like = late.share > share and late.is_within(numbers.plausible)
    return is_like and abs(late.lag) > least and evidence.is_like_model_later(signal)


def _is_filtered(evidence: Evidence, found: Fault) -> bool:
    """Whether a filter of the sensor, which is no fault of a clock, explains more of a late signal than a lag."""
    if found.other or found.value is None or found.value <= 0.0:
        return False
    return evidence.run.filtered(found.signal).share > evidence.late[found.signal].share


def _others_are_in_time(evidence: Evidence, signal: str) -> bool:
    """Whether a signal beside one is like the model's without a lag, and it is late against the hub's other signal.

    Play at the gears makes the hub's signals differ as well.
    """
    numbers = evidence.numbers
    if signal in HUB and evidence.hub is not None:
        lag = evidence.late[signal].lag
        behind = lag if signal == HUB[0] else -lag
        if evidence.hub.share > numbers.same_shape or not beats_play(evidence.recording, evidence.gear_ratio, behind, numbers):
            return False
    beside = [other for name, other in evidence.late.items() if name != signal]
    return any(other.share > numbers.similar and abs(other.lag) < numbers.same_lag for other in beside)


def is_drive_delay(faults: Sequence[Fault], recordings: int, numbers: MotionFaults) -> bool:
    """Whether all that is at fault is one lag of all signals in every recording, as a drive that acts late makes it.

    Args:
        faults: of all recordings.
        recordings: their number.
        numbers: of the faults of motion.
    """
    lags = [fault.value for fault in faults if fault.kind == "clock" and not fault.signal and fault.value is not None]
    if not lags or len(lags) != len(faults) or len({fault.recording for fault in faults}) != recordings:
        return False
    return min(lags) > 0.0 and max(lags) <= numbers.longest_drive_delay and max(lags) - min(lags) < numbers.same_lag


def clock_fault(evidence: Evidence, signal: str, lag: float, other: str = "") -> Fault:
    """Describe the lag [s] of a signal against another, else against the model, or of all signals."""
    time, late = f"{abs(lag):.3g} s", "late" if lag > 0.0 else "early"
    against = other or "the model's"
    text = f"is {time} {late} against {against}" if signal else f"all signals are {time} {late} against the command"
    hint = f'{signal or "time"} = {{ shift = "{lag:.3g} s" }}'
    return fault(evidence.recording, signal, "clock", lag, text, hint, other=other)
