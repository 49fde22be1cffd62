"""Constant factors between signals and the model's."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.identify.inspect.agreement import Agreement
from flexarm_env.identify.inspect.command_factor import command_factor
from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.factor_words import factor_fault
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.series import HUB

#: A constant that the factor of a signal of the beam looks like.
STIFFNESS = "beam.bending_stiffness"


def factors(evidence: Evidence) -> list[Fault]:
    """Find factors of signals beside others that agree with the model; else of angle or speed; else of the command."""
    return _of_signals(evidence) or _of_hub(evidence) or command_factor(evidence) or _of_one_signal(evidence)


def _of_signals(evidence: Evidence) -> list[Fault]:
    """Find signals that are a multiple of the model's where another signal of the hub agrees with the model."""
    numbers, found = evidence.numbers, []
    if not evidence.model_holds:
        return []
    for signal, now in evidence.at_once.items():
        off = now.share > numbers.same_shape and now.gain > 0.0 and not now.is_within(numbers.least_factor)
        if off and _hub_concurs(evidence, signal) and _is_beyond_calibration(evidence, signal, now):
            found.append(factor_fault(evidence, signal, _size(evidence, signal, now.gain)))
    return found


def _size(evidence: Evidence, signal: str, gain: float) -> float:
    """Compute a factor from angle and speed beside each other, which no constant of the model changes; else take the gain.

    Both are noisy: the geometric mean of the regressions on either side has no more than half of the bias of one.
    """
    if evidence.hub is None or signal not in HUB:
        return gain
    angle_over_speed = evidence.hub.gain / math.sqrt(evidence.hub.share)
    return angle_over_speed if signal == "arm_angle" else 1.0 / angle_over_speed


def _is_beyond_calibration(evidence: Evidence, signal: str, found: Agreement) -> bool:
    """Whether a factor leaves hardly more than noise, or is beyond the spreads of the sensor's gain and the beam's stiffness."""
    arm = evidence.arm
    gain = arm.parameter(f"sensors.{signal}.gain").spread
    beam = arm.parameter(STIFFNESS).spread if signal not in HUB else 0.0
    far = abs(math.log(found.gain)) > evidence.numbers.spreads * math.hypot(gain, beam)
    return far or evidence.run.leaves_noise(signal, found)


def _hub_concurs(evidence: Evidence, signal: str) -> bool:
    """Whether angle and speed differ from each other as they differ from the model, if a signal is one of them."""
    if evidence.hub is None or signal not in HUB:
        return True
    angle, speed = (evidence.at_once[name].gain for name in HUB)
    ratio = evidence.hub.gain * speed / angle if angle else 0.0
    return evidence.hub_in_step and 1.0 / evidence.numbers.least_factor < ratio < evidence.numbers.least_factor


def _of_hub(evidence: Evidence) -> list[Fault]:
    """Find the factor between angle and speed, and blame the one that is farther from the other signals, or the model."""
    hub, numbers = evidence.hub, evidence.numbers
    if hub is None or not evidence.hub_in_step or hub.gain <= 0.0 or hub.is_within(numbers.least_factor):
        return []
    angle, speed = (abs(evidence.at_once[name].gain) for name in HUB)
    others = [
        abs(found.gain) for name, found in evidence.at_once.items() if name not in HUB and found.share > numbers.shared_motion
    ]
    usual = float(np.median(others)) if others else 1.0
    if min(angle, speed, usual) == 0.0:
        return []
    if abs(math.log(angle / usual)) > abs(math.log(speed / usual)):
        return [factor_fault(evidence, "arm_angle", _size(evidence, "arm_angle", angle))]
    return [factor_fault(evidence, "motor_speed", _size(evidence, "motor_speed", speed))]


def _of_one_signal(evidence: Evidence) -> list[Fault]:
    """Find a signal that is far from the model where all others move as it does, and nearly agree with each other."""
    numbers, found = evidence.numbers, []
    for signal, now in evidence.at_once.items():
        others = evidence.others(signal)
        gains = [other.gain for other in others]
        judged = len(gains) > 1 and (signal not in HUB or evidence.hub is None)
        alike = all(other.share > numbers.similar and other.gain > 0.0 for other in (now, *others))
        if judged and alike and max(gains) < numbers.plausible * min(gains):
            nearest = min(abs(math.log(now.gain / gain)) for gain in gains)
            if nearest > math.log(numbers.far_apart):
                found.append(factor_fault(evidence, signal, now.gain / float(np.median(gains)), roughly=True))
    return found
