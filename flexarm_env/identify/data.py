"""Recordings made ready for identification: whitened, with a start state and a part that is held out."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.load import check_load, loaded_plants, payload_of
from flexarm_env.identify.recording import Recording
from flexarm_env.identify.run import Run, cut
from flexarm_env.identify.scales import scales_of
from flexarm_env.identify.start import find_start
from flexarm_env.parameters import reading_noise
from flexarm_env.plant.plant import NO_INTERVALS, Plant
from flexarm_env.signals import INPUTS

Floats = NDArray[np.float64]

#: Share of each recording, at its end, that no fit sees.
HELD_OUT = 0.35
#: Noise assumed of a signal whose arm file states none: this share of its range.
DEFAULT_NOISE = 2e-3
WINDOW = 1.0
FEWEST_SAMPLES = 50


@dataclass(frozen=True)
class Data:
    """Runs of one arm with their common sampling time [s] and the standard deviation of each signal's noise.

    Attributes:
        runs: one for each recording.
        signals: names in the order of the columns.
        interval: sampling time [s].
        noise: (signals,) standard deviation, SI units.
        scales: by unit and for "command", how much larger quantities are here than in the thesis's arm, which typical sizes fit.
    """

    runs: list[Run]
    signals: list[str]
    interval: float
    noise: Floats
    scales: Mapping[str, float]

    @functools.cached_property
    def fitted(self) -> list[Run]:
        """The runs cut down to the part that fits see."""
        return [cut(run, int(run.train.sum())) for run in self.runs]

    def plants(self, arm: Arm) -> dict[float, Plant]:
        """Return an arm's plants by the payload [kg] of the runs, which carry it."""
        return loaded_plants(arm, (run.payload for run in self.runs), self.interval)


def everything(data: Data) -> Data:
    """Return the data with nothing held out."""
    return replace(data, runs=[replace(run, train=np.ones_like(run.train)) for run in data.runs])


def prepare(arm: Arm, recordings: Sequence[Recording]) -> tuple[Arm, Data]:
    """Return the arm reduced to the sensors that all recordings have, and the recordings as arrays.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    if not recordings:
        raise InputError("no recordings: name at least one CSV file or a folder of them")
    signals = [s for s in arm.signals if all(s in r.signals for r in recordings)]
    if not signals:
        raise InputError(f"no signal is in all recordings and in arm '{arm.name}', which has {', '.join(arm.signals)}")
    for recording in recordings:
        if recording.input_kind != arm.input:
            other = next(kind for kind in INPUTS if kind != arm.input)
            raise InputError(f"{recording.name} holds {other}, but arm '{arm.name}' is driven by {arm.input}")
        check_load(arm, recording)
        if len(recording) < FEWEST_SAMPLES:
            raise InputError(f"{recording.name} has {len(recording)} samples; at least {FEWEST_SAMPLES} are needed")
    intervals = [r.sample_time for r in recordings]
    interval = float(np.median(intervals))
    arm = _with_sensors(arm, signals)
    measured = [np.stack([r.signals[s] for s in signals], axis=1) for r in recordings]
    noise = _noise(arm, signals, measured)
    runs = [_run(r, m, signals, noise, interval) for r, m in zip(recordings, measured, strict=True)]
    return arm, Data(runs, signals, interval, noise, scales_of(arm, runs, signals))


def _with_sensors(arm: Arm, signals: list[str]) -> Arm:
    return replace(arm, sensors={s: arm.sensors[s] for s in signals})


def _noise(arm: Arm, signals: list[str], measured: list[Floats]) -> Floats:
    stated = [reading_noise(arm.sensors[s]) for s in signals]
    spread = np.ptp(np.concatenate(measured), axis=0)
    return np.array([n if n > 0.0 else max(DEFAULT_NOISE * w, 1e-12) for n, w in zip(stated, spread, strict=True)])


def _run(recording: Recording, measured: Floats, signals: list[str], noise: Floats, interval: float) -> Run:
    time = recording.time - recording.time[0]
    steps = np.diff(time)
    uneven = np.abs(steps - interval).max() > 1e-3 * interval
    train = time < (1.0 - HELD_OUT) * time[-1]
    return Run(
        name=recording.name,
        time=time,
        command=np.ascontiguousarray(recording.command),
        measured=np.ascontiguousarray(measured),
        intervals=np.append(steps, interval) if uneven else NO_INTERVALS,
        train=train,
        start=find_start(time, measured, signals, noise),
        payload=payload_of(recording),
    )
