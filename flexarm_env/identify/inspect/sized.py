"""Faults with their sizes estimated from all recordings that have them."""

from __future__ import annotations

from collections.abc import Sequence

from flexarm_env.identify.inspect.calibrated_size import calibrated_size
from flexarm_env.identify.inspect.clock import clock_fault
from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.factor import is_relative
from flexarm_env.identify.inspect.factor_words import factor_fault
from flexarm_env.identify.inspect.fault import Fault


def sized(evidence: Sequence[Evidence], faults: Sequence[Fault]) -> list[Fault]:
    """Estimate the sizes of lags and factors anew where the constants of the model would bias them.

    Args:
        evidence: on each recording.
        faults: of any of the recordings, those of one kind and signal at sizes that are near each other.
    """
    found: list[Fault] = []
    for one in faults:
        twins = [other for other in faults if _key(other) == _key(one)]
        names = {other.recording for other in twins}
        own = [e for e in evidence if e.recording.name in names]
        if one is twins[0] and all(map(lambda e: _is_biased(e, one), own)):
            value = calibrated_size(own, one)
            found += [_of_size(e, one, value) for e in own]
        elif not any(other.kind == one.kind and other.signal == one.signal for other in found):
            found += twins
    return found


def _key(fault: Fault) -> tuple[str, str, str]:
    return fault.kind, fault.signal, fault.other


def _is_biased(evidence: Evidence, fault: Fault) -> bool:
    """Whether wrong constants would bias the size of a fault, and the model is near enough to estimate them beside it."""
    if fault.kind == "clock":
        return not fault.other
    is_factor = fault.kind == "factor" and not fault.other and fault.signal in evidence.signals
    return is_factor and evidence.model_holds and not is_relative(evidence, fault.signal)


def _of_size(evidence: Evidence, fault: Fault, value: float) -> Fault:
    if fault.kind == "clock":
        return clock_fault(evidence, fault.signal, value)
    return factor_fault(evidence, fault.signal, value)
