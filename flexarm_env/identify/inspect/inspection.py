"""Inspect recordings before any search: the faults of their signals, each with its size and the line that mends it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.both import with_common_lines
from flexarm_env.identify.inspect.catalogue import CHECKS
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.mend import mended
from flexarm_env.identify.inspect.motion import motion_faults, moves_as_model
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.inspect.signal_facts import SignalFacts, sensor_noise, signal_facts
from flexarm_env.identify.replay.dataset import check_given
from flexarm_env.identify.replay.reading_noise import NoiseBySignal
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.recordings.recording import Recording


@dataclass(frozen=True)
class Inspection:
    """What an inspection of recordings has found.

    Attributes:
        faults: of sensors, units and files.
        signals: facts on every signal of every recording.
        mended: the recordings with the faults of their readings undone, or left out as NaN.
        seconds: time taken.
        noises: of the arm's sensors, by all recordings.
    """

    faults: tuple[Fault, ...]
    signals: tuple[SignalFacts, ...]
    mended: tuple[Recording, ...]
    seconds: float
    noises: NoiseBySignal = field(default_factory=dict)

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

    Raises:
        InputError: for what is no arm or no list of recordings.

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
    check_given(arm, recordings)
    began = time.perf_counter()
    faults: list[Fault] = []
    sound: list[Recording] = []
    for recording in recordings:
        inspected = Inspected.of(recording)
        found, left = reading_faults(arm, inspected, settings)
        faults += found
        sound.append(left)
    noises = sensor_noise(arm, recordings, sound, settings)
    faults = with_common_lines(with_motion_faults(arm, recordings, sound, faults, noises, settings))
    facts = signal_facts(recordings, sound, noises, settings)
    return Inspection(tuple(faults), facts, tuple(sound), time.perf_counter() - began, noises)


def with_motion_faults(
    arm: Arm,
    recordings: Sequence[Recording],
    sound: Sequence[Recording],
    faults: list[Fault],
    noises: NoiseBySignal,
    settings: Settings,
) -> list[Fault]:
    """Add the faults that the motion shows. Commands beyond the limit are in another unit where that explains the motion.

    Args:
        arm: the model.
        recordings: as read.
        sound: the same with the faults of their readings mended.
        faults: of their readings.
        noises: of the arm's sensors.
        settings: numbers of the method.
    """
    if any(one.kind == "limit" for one in faults) and not moves_as_model(arm, sound, settings, noises):
        others = [one for one in faults if one.kind != "limit"]
        as_read = [replace(left, command=one.command[: len(left)]) for left, one in zip(sound, recordings, strict=True)]
        found = motion_faults(arm, as_read, settings, noises)
        if any(one.kind == "factor" and one.signal == arm.input for one in found):
            return others + found
    return faults + motion_faults(arm, sound, settings, noises)


def reading_faults(arm: Arm, inspected: Inspected, settings: Settings = SETTINGS) -> tuple[list[Fault], Recording]:
    """Find the faults of a recording that its readings show without a model, and mend them in memory."""
    faults: list[Fault] = []
    for check in CHECKS:
        counted = {one.signal for one in faults if one.kind == "wrap"}
        found = [one for one in check(inspected, arm, settings.inspecting) if one.kind != "rail" or one.signal not in counted]
        faults += found
        inspected = replace(inspected, recording=mended(inspected.recording, found))
    return faults, inspected.recording
