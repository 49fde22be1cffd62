"""A constant factor of the command, or of the only signal: with one signal alone the two look alike."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from flexarm_env.errors import InputError
from flexarm_env.identify.inspect.agreement import Agreement
from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.factor_words import factor_fault
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.free_run import FreeRun, Table, replayer

#: Constants that a factor of the command, or of all signals, looks like.
TORQUE, INERTIA = "drive.torque_constant", "hub.inertia"


def command_factor(evidence: Evidence) -> list[Fault]:
    """Find the factor of the command with which all signals are like the model, where none has the model's size without."""
    numbers, at_once = evidence.numbers, evidence.at_once
    if any(found.is_within(numbers.least_factor) and found.share > numbers.similar for found in at_once.values()):
        return []
    command, factor = evidence.recording.input_kind, _search(evidence)
    mended = evidence.replayer.free_run(factor).at_once() if factor else {}
    if len(at_once) == 1:
        return _of_signal_or_command(evidence, factor, mended)
    return [factor_fault(evidence, command, factor)] if factor and _is_certain(evidence, factor, mended) else []


def _of_signal_or_command(evidence: Evidence, factor: float, mended: Table) -> list[Fault]:
    """Find the factor of the only signal, or of the command if that explains more."""
    command, (signal,) = evidence.recording.input_kind, evidence.signals
    gain, alone = _refined(evidence, signal)
    if factor and mended[signal].share_at_one > alone.share_at_one:
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
        try:
            run = replayer(evidence.arm, mended, evidence.replayer.dataset.settings).free_run()
        except InputError:  # so large a factor that the arm could not have been recorded
            break
        now = run.agreement(signal, signal)
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


def _search(evidence: Evidence) -> float:
    """Search the factor of the command with which the middle gain of the signals is 1; 0 where there is none."""
    numbers = evidence.numbers
    gain = _middle_gain(evidence.run)
    starts = [(factor, 0.0) for factor in numbers.command_factors]
    for start in [(1.0 / gain, 1.0), *starts] if gain > 0.0 else starts:
        factor, moved = start
        for _ in range(numbers.command_steps):
            gain = _middle_gain(evidence.replayer.free_run(factor))
            if gain > 0.0 and abs(math.log(gain)) < numbers.command_close:
                return _polished(evidence, factor)
            if gain > 0.0:
                factor, moved = factor / gain, factor
            elif moved:
                factor = math.sqrt(factor * moved)
            else:
                break
            if abs(math.log(factor)) > math.log(numbers.largest_factor):
                break
    return 0.0


def _polished(evidence: Evidence, factor: float) -> float:
    """Move a factor to where the signals are explained best: friction makes the middle gain rough."""
    best, explained, step = factor, _explained(evidence, factor), evidence.numbers.polishing_step
    while step > evidence.numbers.command_close / 2:
        tried = {other: _explained(evidence, other) for other in (best * (1.0 + step), best / (1.0 + step))}
        better = max(tried, key=lambda other: tried[other])
        if tried[better] > explained:
            best, explained = better, tried[better]
        else:
            step *= 0.5
    return best


def _explained(evidence: Evidence, factor: float) -> float:
    return sum(found.share_at_one for found in evidence.replayer.free_run(factor).at_once().values())


def _middle_gain(run: FreeRun) -> float:
    """Compute the median gain of the signals; 0 where one has too little in common with the model."""
    found = run.at_once().values()
    if min(one.share for one in found) < run.numbers.shared_motion:
        return 0.0
    return float(np.median([one.gain for one in found]))
