"""Checks of recordings before they are compared with a model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from flexarm_env.arm_sections import SECTIONS
from flexarm_env.experiments.stated import PAYLOAD
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.settings import Preparation
from flexarm_env.recordings.noise import Readings, estimate_noise

Floats = NDArray[np.float64]
#: Signals that show whether a motor turns that a tachometer says turns steadily; one at rest may read an offset.
ANGLES = frozenset({"arm_angle", "link_angle"})


@dataclass(frozen=True)
class Preflight:
    """What a look at recordings says before a model is calibrated.

    Attributes:
        notes: for a person, a line each.
        too_short: whether they are too short to judge an arm.
        too_still: whether nothing moves beyond the noise.
    """

    notes: tuple[str, ...]
    too_short: bool
    too_still: bool

    @property
    def too_poor(self) -> bool:
        """Whether they are insufficient to judge an arm."""
        return self.too_short or self.too_still


def preflight(dataset: Dataset) -> Preflight:
    """Check recordings before a model is calibrated."""
    numbers = dataset.settings.preparation
    length = sum(run.time[-1] for run in dataset.runs)
    noise = _noise(dataset)
    motions = [_motion(run, dataset, noise) for run in dataset.runs]
    checked = Preflight((), length < numbers.shortest, max(motions) < numbers.least_motion)
    notes = list(dataset.notes)
    for run, motion in zip(dataset.runs, motions, strict=True):
        notes += [f"{run.name}: {note}" for note in _notes(run, motion > numbers.least_motion, numbers)]
    if checked.too_short:
        notes.append(f"only {length:.2g} s of data: record at least 5 s with several starts and stops")
    if checked.too_still:
        notes.append(
            "nothing moves beyond the noise: record a run that breaks away both ways, as `flexarm simulate --input square`"
        )
    return replace(checked, notes=tuple(notes))


def _noise(dataset: Dataset) -> Floats:
    """Give the noise (signals,) of each signal, SI units: as stated or as the recordings show it, the larger of both."""
    columns = [[Readings(run.time, run.measured[:, k]) for run in dataset.runs] for k in range(len(dataset.signals))]
    shown = [found.total if (found := estimate_noise(readings)) else 0.0 for readings in columns]
    return np.maximum(dataset.noise, shown)


def _motion(run: Run, dataset: Dataset, noise: Floats) -> float:
    """Compute the largest motion over the noise; a motor that turns steadily moves, too, where no angle shows that it rests."""
    count = dataset.settings.preparation.motion_readings
    means = [_means(column[np.isfinite(column)], count) for column in run.measured.T]
    turns = [signal == "motor_speed" and ANGLES.isdisjoint(dataset.signals) for signal in dataset.signals]
    largest = [np.abs(mean).max() if turn else np.ptp(mean) for mean, turn in zip(means, turns, strict=True)]
    return float((largest / noise).max())


def _means(readings: Floats, count: int) -> Floats:
    """Compute the means of each `count` readings in a row, whose range hardly grows with the length of a recording at rest."""
    return sliding_window_view(readings, count).mean(axis=1) if len(readings) >= count else np.zeros(1)


def _notes(run: Run, moves: bool, numbers: Preparation) -> list[str]:
    notes = [_stated_note(path, value) for path, value in run.stated]
    notes += [run.loop_note] if run.loop_note else []
    if len(run.intervals):
        notes.append(f"sampled unevenly, {run.intervals.min():.4g} to {run.intervals.max():.4g} s")
    at_limit = np.abs(run.command) >= numbers.at_limit * np.abs(run.command).max()
    varies = np.ptp(run.command) > numbers.one_command * np.abs(run.command).max()
    if at_limit.mean() > numbers.much_at_limit and varies and len(np.unique(run.command)) > numbers.fewest_levels:
        notes.append(f"the command stays at its largest value {100 * at_limit.mean():.0f} % of the time")
    if varies and not np.nanmax(run.extent):
        notes.append("every signal keeps one value while the command changes: are the sensors connected, and was it recorded?")
    if moves and not varies:
        held = f"{float(run.command[0]):g} in every row"
        notes.append(f"the command is {held}, which explains a release or a single step alone: was it recorded?")
    return notes


def _stated_note(path: str, value: float) -> str:
    """Describe one condition that a recording states of the machine."""
    if path == PAYLOAD:
        return f"the arm carries the {value:g} kg that the recording states as its payload"
    section, key = path.split(".")
    return f"{path} is {value:g} {SECTIONS[section][key].unit}".rstrip() + ", as the recording states"
