"""Two signals that are exchanged."""

from __future__ import annotations

from itertools import combinations

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault


def exchanged_signals(evidence: Evidence) -> list[Fault]:
    """Find pairs of signals each of which agrees with the model of the other, and not with its own."""
    off = [signal for signal in evidence.signals if not evidence.agrees(signal)]
    return [_fault(evidence, *pair) for pair in combinations(off, 2) if _agree_crosswise(evidence, *pair)]


def _agree_crosswise(evidence: Evidence, one: str, other: str) -> bool:
    numbers, run = evidence.numbers, evidence.run
    crosswise = run.agreement(one, other), run.agreement(other, one)
    return all(found.is_within(numbers.near) and found.share > numbers.same_shape for found in crosswise)


def _fault(evidence: Evidence, one: str, other: str) -> Fault:
    recording = evidence.recording
    return Fault(
        recording=recording.name,
        source=recording.source,
        signal=one,
        kind="swapped",
        value=None,
        unit="",
        message=f"{one} and {other} are exchanged: each moves as the model's other does",
        hint=f"exchange the columns of {one} and {other}",
        other=other,
    )
