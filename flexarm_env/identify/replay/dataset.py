"""Recordings prepared for identification: whitened, with an initial state and a part that is held out."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.stated import Stated, check_stated, plants_by_stated, stated_by
from flexarm_env.identify.replay.initial_state import find_start
from flexarm_env.identify.replay.loop import Loop, find_loop
from flexarm_env.identify.replay.plausible import check_free_motion, check_steps
from flexarm_env.identify.replay.reading_noise import SensorNoise, find_noise, is_open, with_found_noise
from flexarm_env.identify.replay.readings import measured_time, share_of
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.scales import scales_of
from flexarm_env.identify.replay.start_fit import Stretch
from flexarm_env.identify.replay.thinning import thin
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.plant.plant import NO_INTERVALS, Plant
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
        notes: a line each for a person, on noise and on samples that are left out.
    """

    runs: tuple[Run, ...]
    signals: tuple[str, ...]
    interval: float
    noise: Floats
    scales: Mapping[str, float]
    settings: Settings
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

    def plants(self, arm: Arm) -> dict[Stated, Plant]:
        """Build an arm's plants by what the runs state of it."""
        return plants_by_stated(arm, (run.stated for run in self.runs), self.interval)

    def stretch(self, run: Run, loop: Loop | None = None) -> Stretch:
        """Cut out the first samples of a run, to which its initial state is fitted.

        Args:
            run: the recording.
            loop: in which the samples are replayed; under the recorded command without.
        """
        count = run.start.samples
        samples = run.command[:count], run.intervals[:count], run.measured[:count]
        loop = None if loop is None else loop.first(count)
        return Stretch(run.start, *samples, self.noise, self.settings.initial_states, loop)

    def nothing_held_out(self) -> Dataset:
        """Give the same runs with nothing held out."""
        return replace(self, runs=tuple(replace(run, train=np.ones_like(run.train)) for run in self.runs))


def prepare(
    arm: Arm, recordings: Sequence[Recording], settings: Settings = SETTINGS, rate: float | None = None
) -> tuple[Arm, Dataset]:
    """Reduce an arm to the sensors that all recordings have, and prepare the recordings for it.

    Args:
        arm: the model.
        recordings: of the machine.
        settings: numbers of the method.
        rate: samples per second [Hz] that are kept; 0 keeps all. By default, as many as the arm needs.

    Returns:
        The arm, with the noise of its sensors, and the recordings.

    Raises:
        InputError: for recordings that do not fit the arm, or under whose commands and times it moves beyond any arm.
    """
    if not recordings:
        raise InputError("no recordings: name at least one CSV file or a folder of them")
    signals = [s for s in arm.signals if all(s in r.signals for r in recordings)]
    if not signals:
        raise InputError(f"no signal is in all recordings and in arm '{arm.name}', which has {', '.join(arm.signals)}")
    arm = replace(arm, sensors={s: arm.sensors[s] for s in signals})
    for recording in recordings:
        _check(arm, recording, settings.preparation.fewest_samples)
        check_steps(recording, settings.preparation)
        check_free_motion(arm, recording, settings.preparation)
    noises = find_noise(arm, recordings)
    if is_open(noises, settings.preparation):
        noises = find_noise(arm, recordings, _replayed(arm, _dataset(arm, recordings, noises, settings)))
    arm = with_found_noise(arm, noises, settings.preparation)
    units = [arm.sensor(s).unit for s in signals]
    notes = [note for n, unit in zip(noises, units, strict=True) if (note := n.note(unit, settings.preparation))]
    kept, thinned = thin(arm, recordings, _deviations(noises, settings), settings, rate)
    return arm, replace(_dataset(arm, kept, noises, settings), notes=(*notes, *thinned))


def _deviations(noises: Sequence[SensorNoise], settings: Settings) -> Floats:
    return np.array([noise.deviation(settings.preparation) for noise in noises])


def _dataset(arm: Arm, recordings: Sequence[Recording], noises: Sequence[SensorNoise], settings: Settings) -> Dataset:
    interval = float(np.median([r.sample_time for r in recordings]))
    noise = _deviations(noises, settings)
    runs = tuple(_run(arm, recording, noise, interval, settings) for recording in recordings)
    return Dataset(
        runs, tuple(arm.signals), interval, noise, scales_of(arm, runs, list(arm.signals), settings.reference), settings
    )


def _readings(arm: Arm, recording: Recording) -> Floats:
    """Stack the readings (samples, signals) of an arm's sensors, SI units."""
    return np.stack([recording.signals[signal] for signal in arm.signals], axis=1)


def _replayed(arm: Arm, dataset: Dataset) -> list[Floats]:
    """Replay each run freely: readings (samples, signals)."""
    plants, found = dataset.plants(arm), []
    for run in dataset.runs:
        plant, stretch = plants[run.stated], dataset.stretch(run)
        stretch.place(plant, stretch.fit(plant))
        found.append(plant.replay(run.command, run.intervals))
    return found


def _check(arm: Arm, recording: Recording, fewest: int) -> None:
    if recording.input_kind != arm.input:
        raise InputError(f"{recording.name} holds {recording.input_kind}, but arm '{arm.name}' is driven by {arm.input}")
    check_stated(arm, recording)
    count = int(np.count_nonzero(share_of(_readings(arm, recording))))
    if count < fewest:
        with_readings = f" with a reading of {' or '.join(arm.signals)}" if count < len(recording) else ""
        raise InputError(f"{recording.name} has {count} samples{with_readings}; at least {fewest} are needed")


def _run(arm: Arm, recording: Recording, noise: Floats, interval: float, settings: Settings) -> Run:
    numbers = settings.preparation
    signals, measured = list(arm.signals), _readings(arm, recording)
    time = recording.time - recording.time[0]
    steps, shown = np.diff(time), measured_time(time, measured)
    # Wider than in a simulation, where only rounding counts as even: tables for one interval make replays fast.
    uneven = np.abs(steps - interval).max() > numbers.uneven * interval
    start = find_start(time, recording.command, measured, signals, noise, settings.initial_states)
    loop, note = find_loop(arm, recording, signals, start.speed, numbers)
    return Run(
        name=recording.name,
        time=time,
        command=np.ascontiguousarray(recording.command),
        measured=np.ascontiguousarray(measured),
        intervals=np.append(steps, interval) if uneven else NO_INTERVALS,
        train=shown < (1.0 - numbers.held_out_share) * shown[-1],
        start=start,
        stated=stated_by(arm, recording),
        loop=loop,
        loop_note=note,
    )
