"""Faults that recordings have in common: a unit, a sign or a clock is that of a logger, not of one run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from flexarm_env.identify.inspect.clock import clock_fault
from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.factor_words import is_of_unit
from flexarm_env.identify.inspect.fault import Fault

Key = tuple[str, str, str]


def in_common(evidence: Sequence[Evidence], found: Sequence[Sequence[Fault]]) -> list[Fault]:
    """Give all recordings the faults that most of them show, at the median size, alone; else drop small factors that few show.

    Args:
        evidence: on each recording.
        found: the faults of each, judged alone.
    """
    found = _with_one_lag(evidence, found)
    most = [key for key in _keys(found) if 2 * len(_with_key(found, key)) > len(found)]
    if most:
        middle = [_middle(_with_key(found, key)) for key in most]
        return [replace(one, recording=e.recording.name, source=e.recording.source) for e in evidence for one in middle]
    alone = len(found) == 1
    pairs = zip(evidence, found, strict=True)
    return [one for e, faults in pairs for one in faults if alone or _is_certain(e, one)]


def _with_one_lag(evidence: Sequence[Evidence], found: Sequence[Sequence[Fault]]) -> Sequence[Sequence[Fault]]:
    """Put the lag of all signals at which every faulty recording agrees with the model in place of signs and of other lags.

    Half a period late, a vibration looks turned round, and a whole one late, in time: one recording alone may not tell.
    """
    lags = [fault.value for faults in found for fault in faults if _is_of_all_signals(fault) and fault.value is not None]
    faulty = [one for one, faults in zip(evidence, found, strict=True) if faults]

    def agrees(lag: float) -> float:
        every = [agreement for one in faulty for agreement in one.run.late_by(lag).values()]
        return min(agreement.share if agreement.gain > 0.0 else 0.0 for agreement in every)

    if not lags or agrees(lag := max(lags, key=agrees)) <= evidence[0].numbers.alike:
        return found
    pairs = zip(evidence, found, strict=True)
    return [[clock_fault(one, "", lag)] if faults and all(map(_may_be_a_lag, faults)) else faults for one, faults in pairs]


def _is_of_all_signals(fault: Fault) -> bool:
    return fault.kind == "clock" and not fault.signal


def _may_be_a_lag(fault: Fault) -> bool:
    return fault.kind == "sign" or _is_of_all_signals(fault)


def _key(fault: Fault) -> Key:
    return fault.kind, fault.signal, fault.other


def _keys(found: Sequence[Sequence[Fault]]) -> list[Key]:
    return list(dict.fromkeys(_key(one) for faults in found for one in faults))


def _with_key(found: Sequence[Sequence[Fault]], key: Key) -> list[Fault]:
    return [one for faults in found for one in faults if _key(one) == key]


def _middle(faults: Sequence[Fault]) -> Fault:
    """Choose the fault of median size."""
    ordered = sorted(faults, key=lambda one: one.value or 0.0)
    return ordered[(len(ordered) - 1) // 2]


def _is_certain(evidence: Evidence, fault: Fault) -> bool:
    """Whether one recording shows a fault by itself: any but a factor or a lag that a missing effect could make in it.

    A drive that is always at a limit looks like a factor of the command.
    """
    if fault.kind == "clock":
        late = [fault.signal] if fault.signal else evidence.signals
        return all(evidence.run.leaves_noise(signal, evidence.late[signal]) for signal in late)
    if fault.kind != "factor" or not fault.value:
        return True
    if fault.signal not in evidence.signals:
        return is_of_unit(fault.signal, fault.value)
    far = abs(math.log(fault.value)) > math.log(evidence.numbers.plausible)
    return far or evidence.run.leaves_noise(fault.signal, evidence.at_once[fault.signal])
