"""Settle the noise of an arm's sensors by all recordings together, with the model's motion taken off."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import stated_by, with_stated
from flexarm_env.identify.replay.build_run import build_run, first_stretch, with_sensors
from flexarm_env.identify.replay.reading_noise import NoiseBySignal, find_noise
from flexarm_env.identify.settings import Settings
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


def settle_noise(arm: Arm, recordings: Sequence[Recording], settings: Settings) -> NoiseBySignal:
    """Estimate the noise of an arm's sensors in recordings, first from the readings alone, then with free replays as well.

    Args:
        arm: the model; a sensor that no recording has is left out.
        recordings: of the machine, each with at least one of the arm's sensors; other signals do not count.
        settings: numbers of the method.
    """
    arm = with_sensors(arm, {signal for one in recordings for signal in one.signals})
    first = find_noise(arm, recordings)
    deviations = {signal: noise.deviation(settings.preparation) for signal, noise in first.items()}
    return find_noise(arm, recordings, [_replayed(arm, one, deviations, settings) for one in recordings])


def _replayed(arm: Arm, recording: Recording, deviations: dict[str, float], settings: Settings) -> dict[str, Floats]:
    """Replay a recording freely from its fitted initial state: readings (samples,) by signal."""
    own = with_sensors(arm, recording.signals)
    noise = np.array([deviations[signal] for signal in own.signals])
    run = build_run(own, recording, noise, recording.sample_time, settings)
    plant = with_stated(own, stated_by(own, recording)).plant(recording.sample_time)
    stretch = first_stretch(run, noise, settings.initial_states)
    stretch.place(plant, stretch.fit(plant))
    return dict(zip(own.signals, plant.replay(run.command, run.intervals).T, strict=True))
