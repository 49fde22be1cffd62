"""Facts on the signals of recordings: range, resolution, and the noise that all recordings show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.build_run import with_sensors
from flexarm_env.identify.replay.plausible import check_recording
from flexarm_env.identify.replay.reading_noise import NoiseBySignal, find_noise
from flexarm_env.identify.replay.settle_noise import settle_noise
from flexarm_env.identify.settings import Settings
from flexarm_env.recordings.columns import UNITS
from flexarm_env.recordings.noise import Readings, estimate_noise
from flexarm_env.recordings.recording import Recording
from flexarm_env.recordings.resolution import find_resolution


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
        noise: standard deviation of a reading, of noise and rounding, by all recordings; None where they show none.
    """

    recording: str
    signal: str
    unit: str
    low: float
    high: float
    samples: int
    step: float
    noise: float | None


def sensor_noise(arm: Arm, recordings: Sequence[Recording], sound: Sequence[Recording], settings: Settings) -> NoiseBySignal:
    """Settle the noise of the arm's sensors that any recording has.

    Args:
        arm: the model.
        recordings: as read, which count for a signal that none of the mended ones has.
        sound: the same with the faults of their readings mended.
        settings: numbers of the method.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    of_arm = [one for one in sound if set(one.signals) & set(arm.signals)]
    for one in of_arm:
        check_recording(with_sensors(arm, one.signals), one, settings.preparation)
    settled = settle_noise(arm, of_arm, settings) if of_arm else {}
    as_read = with_sensors(arm, {signal for one in recordings for signal in one.signals} - set(settled))
    return {**settled, **find_noise(as_read, recordings)}


def signal_facts(
    recordings: Sequence[Recording], sound: Sequence[Recording], noises: NoiseBySignal, settings: Settings
) -> tuple[SignalFacts, ...]:
    """Gather the facts on every signal of every recording.

    Args:
        recordings: as read.
        sound: the same with the faults of their readings mended.
        noises: of the arm's sensors; that of other signals is estimated from their readings alone.
        settings: numbers of the method.
    """
    shown = {signal: noise.shown(settings.preparation) for signal, noise in noises.items()}
    for signal in {signal for one in sound for signal in one.signals} - set(noises):
        noise = estimate_noise([Readings(one.time, one.signals[signal]) for one in sound if signal in one.signals])
        shown[signal] = noise.total if noise else None
    return tuple(_facts(one, signal, shown.get(signal)) for one in recordings for signal in one.signals)


def _facts(recording: Recording, signal: str, noise: float | None) -> SignalFacts:
    values = recording.signals[signal][np.isfinite(recording.signals[signal])]
    low, high = (float(f(values)) if len(values) else float("nan") for f in (np.min, np.max))
    return SignalFacts(recording.name, signal, UNITS[signal], low, high, len(values), find_resolution(values), noise)
