"""Recordings prepared for identification: whitened, with an initial state and a part that is held out."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.stated import Stated, plants_of_arms
from flexarm_env.identify.replay.build_run import build_run, first_stretch, with_sensors
from flexarm_env.identify.replay.loop import Loop
from flexarm_env.identify.replay.plausible import check_recording
from flexarm_env.identify.replay.reading_noise import NoiseBySignal, with_found_noise
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.scales import scales_of
from flexarm_env.identify.replay.settle_noise import settle_noise
from flexarm_env.identify.replay.start_fit import Stretch
from flexarm_env.identify.replay.thinning import thin
from flexarm_env.identify.replay.vibrations import count_vibrations
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.plant.plant import Plant
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Dataset:
    """Recordings of one machine, prepared for one arm.

    Attributes:
        runs: one for each recording.
        signals: names in the order of the columns.
        interval: sampling time [s].
        noise: (signals,) standard deviation, SI units.
        scales: by unit and for "command", sizes of quantities over those of the thesis's arm, which typical sizes fit.
        settings: numbers of the method.
        vibrations: slowest ones of a beam that suffice where a replay follows the readings; 0 for all.
        notes: a line each for a person, on noise and on samples that are left out.
    """

    runs: tuple[Run, ...]
    signals: tuple[str, ...]
    interval: float
    noise: Floats
    scales: Mapping[str, float]
    settings: Settings
    vibrations: int = 0
    notes: tuple[str, ...] = ()

    @functools.cached_property
    def fitted(self) -> tuple[Run, ...]:
        """The runs cut down to the part that calibrations see."""
        return tuple(run.first(int(run.train.sum())) for run in self.runs)

    def runs_to_replay(self, held_out: bool) -> tuple[Run, ...]:
        """Choose the runs to replay: whole ones for the held-out part, which comes last; else the fitted part alone."""
        return self.runs if held_out else self.fitted

    @functools.cached_property
    def shares(self) -> Floats:
        """Shares (signals,) of the samples in which each signal was measured."""
        there = np.concatenate([~np.isnan(run.measured) for run in self.runs])
        return np.maximum(there.sum(axis=0), 1) / len(there)

    @functools.cached_property
    def middle_of_travel(self) -> float:
        """Middle of the hub's measured angles, rad; 0 without any."""
        if "arm_angle" not in self.signals:
            return 0.0
        column = self.signals.index("arm_angle")
        angles = np.concatenate([run.measured[:, column] for run in self.runs])
        return float(np.nan_to_num((np.fmin.reduce(angles) + np.fmax.reduce(angles)) / 2.0))

    def readings(self, held_out: bool) -> int:
        """Count the readings of the held-out or the fitted part."""
        return sum(run.readings(~run.train if held_out else run.train) for run in self.runs)

    def readings_by_signal(self, held_out: bool) -> NDArray[np.int64]:
        """Count the readings (signals,) of the held-out or the fitted part."""
        parts = [run.measured[~run.train if held_out else run.train] for run in self.runs]
        return np.sum([np.count_nonzero(~np.isnan(part), axis=0) for part in parts], axis=0)

    @property
    def has_loop(self) -> bool:
        """Whether any run is replayed in closed loop."""
        return any(run.loop is not None for run in self.runs)

    def plants(self, arm: Arm, reduced: bool = False) -> dict[Stated, Plant]:
        """Build an arm's plants by what the runs state of it.

        Args:
            arm: the model.
            reduced: whether its beam is left the `vibrations` alone, for replays that lead to a model and do not judge it.
        """
        return self.plants_of([arm], reduced)[0]

    def plants_of(self, arms: Sequence[Arm], reduced: bool = False) -> list[dict[Stated, Plant]]:
        """Build the plants of each of some arms, as `plants` does: quicker than one by one where only numbers differ."""
        return plants_of_arms(arms, [run.stated for run in self.runs], self.interval, self.vibrations if reduced else 0)

    def stretch(self, run: Run, loop: Loop | None = None) -> Stretch:
        """Cut out the first samples of a run, to which its initial state is fitted.

        Args:
            run: the recording.
            loop: in which the samples are replayed; under the recorded command without.
        """
        return first_stretch(run, self.noise, self.settings.initial_states, loop)

    def nothing_held_out(self) -> Dataset:
        """Give the same runs with nothing held out."""
        return replace(self, runs=tuple(replace(run, train=np.ones_like(run.train)) for run in self.runs))


def check_given(arm: Any, recordings: Any) -> None:
    """Refuse what is no arm, and what is no list of recordings, such as one alone or the name of a file.

    Raises:
        InputError: for such an argument.
    """
    if not isinstance(arm, Arm):
        raise InputError(f"the arm is {str(arm)[:40]!r}, of type {type(arm).__name__}; give an Arm, such as Arm.load('thesis')")
    listed = recordings if isinstance(recordings, list | tuple) else [recordings]
    other = next((one for one in listed if not isinstance(one, Recording)), None)
    if other is not None or not isinstance(recordings, Sequence):
        kind = type(recordings if other is None else other).__name__
        raise InputError(f"recordings: {kind} where a list of Recording belongs; give [recording], or Recording.read_all(paths)")


def prepare(
    arm: Arm,
    recordings: Sequence[Recording],
    settings: Settings = SETTINGS,
    rate: float | None = None,
    noises: NoiseBySignal | None = None,
) -> tuple[Arm, Dataset]:
    """Reduce an arm to the sensors that all recordings have, and prepare the recordings for it.

    Args:
        arm: the model.
        recordings: of the machine.
        settings: numbers of the method.
        rate: samples per second [Hz] that are kept; 0 keeps all. By default, as many as the arm needs.
        noises: of the arm's sensors, where they were settled before.

    Returns:
        The arm, with the noise of its sensors, and the recordings.

    Raises:
        InputError: for recordings that do not fit the arm, or under whose commands and times it moves beyond any arm.
    """
    check_given(arm, recordings)
    if not recordings:
        raise InputError("no recordings: name at least one CSV file or a folder of them")
    signals = [s for s in arm.signals if all(s in r.signals for r in recordings)]
    if not signals:
        raise InputError(f"no signal is in all recordings and in arm '{arm.name}', which has {', '.join(arm.signals)}")
    arm = with_sensors(arm, signals)
    for recording in recordings:
        check_recording(arm, recording, settings.preparation)
    noises = settle_noise(arm, recordings, settings) if noises is None else noises
    own = [noises[signal] for signal in signals]
    arm = with_found_noise(arm, own, settings.preparation)
    notes = [note for one in own if (note := one.note(arm.sensor(one.signal).unit, settings.preparation))]
    deviations = np.array([one.deviation(settings.preparation) for one in own])
    kept, thinned = thin(arm, recordings, deviations, settings, rate)
    return arm, replace(_dataset(arm, kept, deviations, settings), notes=(*notes, *thinned))


def _dataset(arm: Arm, recordings: Sequence[Recording], noise: Floats, settings: Settings) -> Dataset:
    interval = float(np.median([r.sample_time for r in recordings]))
    runs = tuple(build_run(arm, recording, noise, interval, settings) for recording in recordings)
    scales = scales_of(arm, runs, list(arm.signals), settings.reference)
    vibrations = count_vibrations(arm, runs, interval, noise, settings)
    return Dataset(runs, tuple(arm.signals), interval, noise, scales, settings, vibrations)
