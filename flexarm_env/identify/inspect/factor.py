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
        least = numbers.similar if signal not in HUB and _of_beam(evidence, signal) else numbers.same_shape
        off = now.share > least and now.gain > 0.0 and not now.is_within(numbers.least_factor)
        if off and _hub_concurs(evidence, signal) and _is_beyond_calibration(evidence, signal, now):
            found.append(factor_fault(evidence, signal, _size(evidence, signal, now.gain)))
    return found


def _size(evidence: Evidence, signal: str, gain: float) -> float:
    """Compute a factor beside other signals that the model's constants change alike; else take the gain.

    Angle and speed are compared without the model. Both are noisy: the geometric mean of the regressions on either side has no
    more than half of the bias of one. A signal of the beam is compared with the others of the beam.
    """
    if signal not in HUB:
        beside = _of_beam(evidence, signal)
        return gain / float(np.median([other.gain for other in beside])) if beside else gain
    if evidence.hub is None:
        return gain
    angle_over_speed = evidence.hub.gain / math.sqrt(evidence.hub.share)
    return angle_over_speed if signal == "arm_angle" else 1.0 / angle_over_speed


def is_relative(evidence: Evidence, signal: str) -> bool:
    """Whether a factor of a signal is computed beside another signal, so that the model's constants do not change it."""
    return evidence.hub is not None if signal in HUB else bool(_of_beam(evidence, signal))


def _of_beam(evidence: Evidence, signal: str) -> list[Agreement]:
    """List the agreements of the other signals of the beam that move as the model's do, at about its size."""
    numbers = evidence.numbers
    beside = {other: found for other, found in evidence.at_once.items() if other not in HUB and other != signal}
    return [found for found in beside.values() if found.share > numbers.similar and found.is_within(numbers.least_factor)]


def _is_beyond_calibration(evidence: Evidence, signal: str, found: Agreement) -> bool:
    """Whether a factor leaves hardly more than noise, or is beyond the spreads of the sensor's gain and the beam's stiffness.

    The stiffness changes all signals of the beam, and is no part of a factor beside another of them.
    """
    arm = evidence.arm
    gain = arm.parameter(f"sensors.{signal}.gain").spread
    beam = 0.0 if is_relative(evidence, signal) or signal in HUB else arm.parameter(STIFFNESS).spread
    far = abs(math.log(_size(evidence, signal, found.gain))) > evidence.numbers.spreads * math.hypot(gain, beam)
    return far or evidence.run.leaves_noise(signal, found)


def _rough_size(evidence: Evidence, signal: str) -> float:
    """Compute a factor over the middle gain of the signals beside it, those of the beam if it is of the beam."""
    now, others = evidence.at_once[signal], evidence.others(signal)
    beside = (_of_beam(evidence, signal) if signal not in HUB else []) or others
    return now.gain / float(np.median([other.gain for other in beside]))


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
                found.append(
                    factor_fault(evidence, signal, _rough_size(evidence, signal), roughly=not is_relative(evidence, signal))
                )
    return found
