"""Constant factors between a signal, or the command, and the model's."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.factor_words import factor_fault
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.free_run import FreeRun


def factors(evidence: Evidence) -> list[Fault]:
    """Find factors of signals beside others that agree with the model; else of angle or speed; else of the command."""
    return _of_signals(evidence) or _of_hub(evidence) or _of_command(evidence)


def _of_signals(evidence: Evidence) -> list[Fault]:
    numbers, found = evidence.numbers, []
    if not evidence.model_holds:
        return []
    for signal, now in evidence.at_once.items():
        judged_alone = evidence.hub_is_sound and signal in ("arm_angle", "motor_speed")
        if now.share > numbers.same_shape and not now.is_within(numbers.least_factor) and not judged_alone:
            found.append(factor_fault(evidence, signal, now.gain))
    return found


def _of_hub(evidence: Evidence) -> list[Fault]:
    """Find the factor between angle and speed, and blame the one that is farther from the model's."""
    hub, numbers = evidence.hub, evidence.numbers
    if hub is None or hub.share < numbers.in_step or hub.gain <= 0.0 or hub.is_within(numbers.least_factor):
        return []
    angle, speed = (abs(evidence.at_once[signal].gain) for signal in ("arm_angle", "motor_speed"))
    if angle == 0.0 or speed == 0.0:
        return []
    if abs(math.log(angle)) > abs(math.log(speed)):
        return [factor_fault(evidence, "arm_angle", hub.gain)]
    return [factor_fault(evidence, "motor_speed", 1.0 / hub.gain)]


def _of_command(evidence: Evidence) -> list[Fault]:
    """Find the factor of the command with which all signals agree with the model, where none does without."""
    numbers, at_once = evidence.numbers, evidence.at_once
    if any(found.is_within(numbers.least_factor) for found in at_once.values()):
        return []
    command, factor = evidence.recording.input_kind, _command_factor(evidence)
    mended = evidence.replayer.free_run(factor).at_once() if factor else {}
    if len(at_once) == 1:
        ((signal, now),) = at_once.items()
        if now.share > numbers.same_shape and not (factor and mended[signal].share > now.share):
            return [factor_fault(evidence, signal, now.gain, command)]
        return [factor_fault(evidence, command, factor, signal)] if factor else []
    return [factor_fault(evidence, command, factor)] if factor else []


def _command_factor(evidence: Evidence) -> float:
    """Search the factor of the command; 0 where none makes all signals agree."""
    numbers = evidence.numbers
    first = [1.0 / gain for gain in (_middle_gain(evidence.run),) if gain > 0.0]
    for start in (*first, *numbers.command_factors):
        factor, moved = start, 0.0
        for _ in range(numbers.command_steps):
            run = evidence.replayer.free_run(factor)
            gain = _middle_gain(run)
            if gain > 0.0 and abs(math.log(gain)) < numbers.command_close and _all_agree(run):
                return factor / gain
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


def _all_agree(run: FreeRun) -> bool:
    numbers = run.numbers
    return all(found.is_within(numbers.near) and found.share > numbers.alike for found in run.at_once().values())
