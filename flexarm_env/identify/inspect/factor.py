"""Constant factors between a signal, or the command, and the model's."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from flexarm_env.identify.inspect.agreement import Agreement
from flexarm_env.identify.inspect.evidence import HUB, Evidence
from flexarm_env.identify.inspect.factor_words import factor_fault
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.free_run import FreeRun, Table, replayer

#: Constants that a factor of the command, or of all signals, looks like.
TORQUE, INERTIA = "drive.torque_constant", "hub.inertia"
#: One that the factor of a signal of the beam looks like.
STIFFNESS = "beam.bending_stiffness"


def factors(evidence: Evidence) -> list[Fault]:
    """Find factors of signals beside others that agree with the model; else of angle or speed; else of the command."""
    return _of_signals(evidence) or _of_hub(evidence) or _of_command(evidence) or _of_one_signal(evidence)


def _of_signals(evidence: Evidence) -> list[Fault]:
    """Find signals that are a multiple of the model's where another signal of the hub agrees with the model."""
    numbers, found = evidence.numbers, []
    if not evidence.model_holds:
        return []
    for signal, now in evidence.at_once.items():
        off = now.share > numbers.same_shape and now.gain > 0.0 and not now.is_within(numbers.least_factor)
        if off and _hub_concurs(evidence, signal) and _is_beyond_calibration(evidence, signal, now):
            found.append(factor_fault(evidence, signal, now.gain))
    return found


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
        return [factor_fault(evidence, "arm_angle", hub.gain)]
    return [factor_fault(evidence, "motor_speed", 1.0 / hub.gain)]


def _of_one_signal(evidence: Evidence) -> list[Fault]:
    """Find a signal that is far from the model where all others are like it and nearly agree with each other."""
    numbers, found = evidence.numbers, []
    for signal, now in evidence.at_once.items():
        gains = [other.gain for other in evidence.others(signal)]
        alike = all(other.share > numbers.similar for other in (now, *evidence.others(signal)))
        if not (alike and len(gains) > 1 and min(now.gain, *gains) > 0.0 and max(gains) < numbers.plausible * min(gains)):
            continue
        if (signal not in HUB or evidence.hub is None) and all(
            abs(math.log(now.gain / gain)) > math.log(numbers.far_apart) for gain in gains
        ):
            found.append(factor_fault(evidence, signal, now.gain / float(np.median(gains))))
    return found


def _of_command(evidence: Evidence) -> list[Fault]:
    """Find the factor of the command with which all signals are like the model, where none has the model's size without."""
    numbers, at_once = evidence.numbers, evidence.at_once
    if any(found.is_within(numbers.least_factor) and found.share > numbers.similar for found in at_once.values()):
        return []
    command, factor = evidence.recording.input_kind, _command_factor(evidence)
    mended = evidence.replayer.free_run(factor).at_once() if factor else {}
    if len(at_once) == 1:
        return _of_signal_or_command(evidence, factor, mended)
    return [factor_fault(evidence, command, factor)] if factor and _is_certain(evidence, factor, mended) else []


def _of_signal_or_command(evidence: Evidence, factor: float, mended: Table) -> list[Fault]:
    """Find the factor of the only signal, or of the command if that explains more."""
    command, (signal,) = evidence.recording.input_kind, evidence.signals
    gain, alone = _refined(evidence, signal)
    if factor and mended[signal].share > alone.share:
        return [factor_fault(evidence, command, factor, signal)] if _is_certain(evidence, factor, mended) else []
    return [factor_fault(evidence, signal, gain, command)] if _is_certain(evidence, gain, {signal: alone}) else []


def _refined(evidence: Evidence, signal: str) -> tuple[float, Agreement]:
    """Refine the factor of a signal: a start in motion, which is read from the signal, changes as it is mended."""
    recording, now = evidence.recording, evidence.at_once[signal]
    gain = now.gain
    for _ in range(evidence.numbers.signal_steps):
        if gain <= 0.0:
            break
        mended = replace(recording, signals={**recording.signals, signal: recording.signals[signal] / gain})
        now = replayer(evidence.arm, mended, evidence.replayer.dataset.settings).free_run().agreement(signal, signal)
        gain *= now.gain
    return gain, now


def _is_certain(evidence: Evidence, factor: float, mended: Table) -> bool:
    """Whether no constants of the arm explain a factor as well.

    The more of the signals is explained, the smaller a factor is certain. Where hardly more than the noise is left, it must only
    be beyond the spread of the torque constant, which a factor of the current cannot be told from.
    """
    numbers, arm = evidence.numbers, evidence.arm
    if factor <= 0.0:
        return False
    size, least = abs(math.log(factor)), min(found.share for found in mended.values())
    torque, inertia = (arm.parameter(path).spread for path in (TORQUE, INERTIA))
    near = all(found.is_within(numbers.near) for found in mended.values())
    if near and all(evidence.run.leaves_noise(signal, found) for signal, found in mended.items()):
        of_torque = numbers.spreads * torque if arm.input == "current" else 0.0
        return size > max(math.log1p(of_torque), math.log(numbers.least_factor))
    if near and least > numbers.alike:
        return size > numbers.spreads * math.hypot(torque, inertia)
    return least > numbers.similar and size > math.log(numbers.surely_a_unit)


def _command_factor(evidence: Evidence) -> float:
    """Search the factor of the command with which the middle gain of the signals is 1; 0 where there is none."""
    numbers = evidence.numbers
    gain = _middle_gain(evidence.run)
    starts = [(factor, 0.0) for factor in numbers.command_factors]
    for start in [(1.0 / gain, 1.0), *starts] if gain else starts:
        factor, moved = start
        for _ in range(numbers.command_steps):
            gain = _middle_gain(evidence.replayer.free_run(factor))
            if gain > 0.0 and abs(math.log(gain)) < numbers.command_close:
                return factor
            if gain > 0.0:
                factor, moved = factor / gain, factor
            elif moved:
                factor = math.sqrt(factor * moved)
            else:
                break
    return 0.0


def _middle_gain(run: FreeRun) -> float:
    """Compute the median gain of the signals; 0 where one has too little in common with the model."""
    found = run.at_once().values()
    if min(one.share for one in found) < run.numbers.shared_motion:
        return 0.0
    return float(np.median([one.gain for one in found]))
