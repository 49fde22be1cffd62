"""Inspect recordings before any search: the faults of their signals, each with its size and the line that mends it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.catalogue import CHECKS
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.mend import mended
from flexarm_env.identify.inspect.motion import motion_faults, moves_as_model
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.recordings.columns import UNITS
from flexarm_env.recordings.recording import Recording


@dataclass(frozen=True)
class SignalFacts:
    """One signal of one recording, as it was read.

    Attributes:
        recording: its name.
        signal: its name.
        unit: SI.
        low: smallest reading.
        high: largest reading.
        samples: how many readings there are.
        step: resolution of the readings; 0 where none shows.
        noise: standard deviation of a reading, of noise and rounding; None where the readings show none.
    """

    recording: str
    signal: str
    unit: str
    low: float
    high: float
    samples: int
    step: float
    noise: float | None


@dataclass(frozen=True)
class Inspection:
    """What an inspection of recordings has found.

    Attributes:
        faults: of sensors, units and files.
        signals: facts on every signal of every recording.
        mended: the recordings with the faults of their readings undone, or left out as NaN.
        seconds: time taken.
    """

    faults: tuple[Fault, ...]
    signals: tuple[SignalFacts, ...]
    mended: tuple[Recording, ...]
    seconds: float

    @property
    def notes(self) -> list[str]:
        """A line for each fault, with its recording and the line that mends it."""
        return [one.line for one in self.faults]


def inspect_recordings(arm: Arm, recordings: Sequence[Recording], settings: Settings = SETTINGS) -> Inspection:
    """Inspect recordings of an arm's machine.

    Args:
        arm: the model.
        recordings: of the machine.
        settings: numbers of the method.

    Returns:
        The faults found, and facts on the signals.

    Example:
        >>> import numpy as np
        >>> from dataclasses import replace
        >>> from flexarm_env import Arm, inspect_recordings, simulate
        >>> arm = Arm.load("thesis")
        >>> run = simulate(arm, "pulse", duration=3.0)
        >>> inspect_recordings(arm, [run]).faults
        ()
        >>> cut = run.signals | {"strain_base": np.clip(run.signals["strain_base"], -1.5, 1.5)}
        >>> [(fault.kind, fault.signal, fault.value) for fault in inspect_recordings(arm, [replace(run, signals=cut)]).faults]
        [('rail', 'strain_base', 1.5)]
    """
    began = time.perf_counter()
    faults: list[Fault] = []
    sound: list[Recording] = []
    facts: list[SignalFacts] = []
    for recording in recordings:
        inspected = Inspected.of(recording)
        found, left = reading_faults(arm, inspected, settings)
        faults += found
        sound.append(left)
        facts += [_facts(inspected, signal) for signal in recording.signals]
    faults = with_motion_faults(arm, recordings, sound, faults, settings)
    return Inspection(tuple(faults), tuple(facts), tuple(sound), time.perf_counter() - began)


def with_motion_faults(
    arm: Arm, recordings: Sequence[Recording], sound: Sequence[Recording], faults: list[Fault], settings: Settings
) -> list[Fault]:
    """Add the faults that the motion shows. Commands beyond the limit are in another unit where that explains the motion.

    Args:
        arm: the model.
        recordings: as read.
        sound: the same with the faults of their readings mended.
        faults: of their readings.
        settings: numbers of the method.
    """
    if any(one.kind == "limit" for one in faults) and not moves_as_model(arm, sound, settings):
        others = [one for one in faults if one.kind != "limit"]
        as_read = [replace(left, command=one.command[: len(left)]) for left, one in zip(sound, recordings, strict=True)]
        found = motion_faults(arm, as_read, settings)
        if any(one.kind == "factor" and one.signal == arm.input for one in found):
            return others + found
    return faults + motion_faults(arm, sound, settings)


def reading_faults(arm: Arm, inspected: Inspected, settings: Settings = SETTINGS) -> tuple[list[Fault], Recording]:
    """Find the faults of a recording that its readings show without a model, and mend them in memory."""
    faults: list[Fault] = []
    for check in CHECKS:
        counted = {one.signal for one in faults if one.kind == "wrap"}
        found = [one for one in check(inspected, arm, settings.inspecting) if one.kind != "rail" or one.signal not in counted]
        faults += found
        inspected = replace(inspected, recording=mended(inspected.recording, found))
    return faults, inspected.recording


def _facts(inspected: Inspected, signal: str) -> SignalFacts:
    recording, found = inspected.recording, inspected.noise[signal]
    values = recording.signals[signal][np.isfinite(recording.signals[signal])]
    low, high = (float(f(values)) if len(values) else float("nan") for f in (np.min, np.max))
    step, noise = (found.resolution, found.total) if found else (0.0, None)
    return SignalFacts(recording.name, signal, UNITS[signal], low, high, len(values), step, noise)
