"""Recordings prepared for identification: whitened, with an initial state and a part that is held out."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.payload import check_payload, plants_by_payload, stated_payload
from flexarm_env.identify.replay.initial_state import Stretch, find_start
from flexarm_env.identify.replay.readings import extent, measured_time, share_of
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.scales import scales_of
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.parameters import INPUTS, reading_noise
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
    """

    runs: tuple[Run, ...]
    signals: tuple[str, ...]
    interval: float
    noise: Floats
    scales: Mapping[str, float]
    settings: Settings

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

    def plants(self, arm: Arm) -> dict[float, Plant]:
        """Build an arm's plants by the payload [kg] of the runs, which carry it."""
        return plants_by_payload(arm, (run.payload for run in self.runs), self.interval)

    def set_initial_state(self, plant: Plant, run: Run) -> None:
        """Fit the initial state to the first samples of a run, and put a plant into it."""
        count = run.start.samples
        stretch = run.command[:count], run.intervals[:count], run.measured[:count]
        Stretch(run.start, *stretch, self.noise, self.settings.initial_states).set_fitted_state(plant)

    def nothing_held_out(self) -> Dataset:
        """Give the same runs with nothing held out."""
        return replace(self, runs=tuple(replace(run, train=np.ones_like(run.train)) for run in self.runs))


def prepare(arm: Arm, recordings: Sequence[Recording], settings: Settings = SETTINGS) -> tuple[Arm, Dataset]:
    """Reduce an arm to the sensors that all recordings have, and prepare the recordings for it.

    Args:
        arm: the model.
        recordings: of the machine.
        settings: numbers of the method.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    if not recordings:
        raise InputError("no recordings: name at least one CSV file or a folder of them")
    signals = [s for s in arm.signals if all(s in r.signals for r in recordings)]
    if not signals:
        raise InputError(f"no signal is in all recordings and in arm '{arm.name}', which has {', '.join(arm.signals)}")
    measured = [np.stack([r.signals[s] for s in signals], axis=1) for r in recordings]
    for recording, readings in zip(recordings, measured, strict=True):
        _check(arm, recording, readings, settings.preparation.fewest_samples)
    interval = float(np.median([r.sample_time for r in recordings]))
    arm = replace(arm, sensors={s: arm.sensors[s] for s in signals})
    noise = _noise(arm, signals, measured, settings)
    runs = tuple(_run(r, m, signals, noise, interval, settings) for r, m in zip(recordings, measured, strict=True))
    scales = scales_of(arm, runs, signals, settings.reference)
    return arm, Dataset(runs, tuple(signals), interval, noise, scales, settings)


def _check(arm: Arm, recording: Recording, measured: Floats, fewest: int) -> None:
    if recording.input_kind != arm.input:
        other = next(kind for kind in INPUTS if kind != arm.input)
        raise InputError(f"{recording.name} holds {other}, but arm '{arm.name}' is driven by {arm.input}")
    check_payload(arm, recording)
    count = int(np.count_nonzero(share_of(measured)))
    if count < fewest:
        with_readings = f" with a reading of {' or '.join(arm.signals)}" if count < len(recording) else ""
        raise InputError(f"{recording.name} has {count} samples{with_readings}; at least {fewest} are needed")


def _noise(arm: Arm, signals: list[str], measured: list[Floats], settings: Settings) -> Floats:
    numbers = settings.preparation
    stated = [reading_noise(arm.sensors[s]) for s in signals]
    spread = extent(np.concatenate(measured))
    pairs = zip(stated, spread, strict=True)
    return np.array([n if n > 0.0 else max(numbers.default_noise * w, numbers.least_noise) for n, w in pairs])


def _run(recording: Recording, measured: Floats, signals: list[str], noise: Floats, interval: float, settings: Settings) -> Run:
    numbers = settings.preparation
    time = recording.time - recording.time[0]
    steps, shown = np.diff(time), measured_time(time, measured)
    # Wider than in a simulation, where only rounding counts as even: tables for one interval make replays fast.
    uneven = np.abs(steps - interval).max() > numbers.uneven * interval
    return Run(
        name=recording.name,
        time=time,
        command=np.ascontiguousarray(recording.command),
        measured=np.ascontiguousarray(measured),
        intervals=np.append(steps, interval) if uneven else NO_INTERVALS,
        train=shown < (1.0 - numbers.held_out_share) * shown[-1],
        start=find_start(time, measured, signals, noise, settings.initial_states),
        payload=stated_payload(recording),
    )
