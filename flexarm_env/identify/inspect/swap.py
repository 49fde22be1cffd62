"""Two signals that are exchanged."""

from __future__ import annotations

import math
from itertools import combinations

from flexarm_env.identify.inspect.agreement import Agreement
from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault


def exchanged_signals(evidence: Evidence) -> list[Fault]:
    """Find pairs of signals each of which is like the model of the other, and not like its own."""
    if _hub_is_exchanged(evidence):
        return [_fault(evidence, "arm_angle", "motor_speed")]
    off = [signal for signal in evidence.signals if not evidence.agrees(signal)]
    return [_fault(evidence, *pair) for pair in combinations(off, 2) if _are_exchanged(evidence, *pair)]


def _hub_is_exchanged(evidence: Evidence) -> bool:
    """Whether the speed is the integral of the angle, which needs no model."""
    if evidence.hub is None or evidence.hub_in_step:
        return False
    crosswise = evidence.run.hub(evidence.gear_ratio, angle="motor_speed", speed="arm_angle")
    return crosswise.share > evidence.numbers.in_step and crosswise.is_within(evidence.numbers.least_factor)


def _are_exchanged(evidence: Evidence, one: str, other: str) -> bool:
    """Whether two signals agree with each other's models, or differ from them by one factor, and far more from their own."""
    numbers, run = evidence.numbers, evidence.run
    own = evidence.at_once[one], evidence.at_once[other]
    crosswise = run.agreement(one, other), run.agreement(other, one)
    if all(found.is_within(numbers.near) and found.share > numbers.same_shape for found in crosswise):
        return True
    if any(found.is_within(numbers.least_factor) and found.share > numbers.similar for found in own):
        return False  # the other one has a factor
    if not all(found.is_within(numbers.plausible) and found.share > numbers.similar for found in crosswise):
        return False
    far = _apart(*own) > numbers.far_apart or all(found.share < numbers.shared_motion for found in own)
    return far and _apart(*crosswise) < numbers.least_factor


def _apart(one: Agreement, other: Agreement) -> float:
    """Compute the factor between two gains; infinite where one is against the model."""
    if one.gain <= 0.0 or other.gain <= 0.0:
        return math.inf
    return max(one.gain / other.gain, other.gain / one.gain)


def _fault(evidence: Evidence, one: str, other: str) -> Fault:
    text = f"and {other} are exchanged: each moves as the model's other does"
    return fault(evidence.recording, one, "swapped", None, text, f"exchange the columns of {one} and {other}", other=other)
