"""Checks of recordings before they are compared with a model."""

from __future__ import annotations

import numpy as np

from flexarm_env.experiments.stated import PAYLOAD
from flexarm_env.identify.replay.dataset import Dataset


def preflight(dataset: Dataset) -> tuple[list[str], bool]:
    """Check recordings before a model is calibrated.

    Returns:
        Notes for a person, a line each; and whether the recordings are too poor to judge an arm.
    """
    numbers = dataset.settings.preparation
    notes = list(dataset.notes)
    for run in dataset.runs:
        notes += [f"{run.name}: {_stated_note(path, value)}" for path, value in run.stated]
        if run.loop_note:
            notes.append(f"{run.name}: {run.loop_note}")
        if len(run.intervals):
            notes.append(f"{run.name}: sampled unevenly, {run.intervals.min():.4g} to {run.intervals.max():.4g} s")
        at_limit = np.abs(run.command) >= numbers.at_limit * np.abs(run.command).max()
        varies = np.ptp(run.command) > 0.0 and len(np.unique(run.command)) > numbers.fewest_levels
        if at_limit.mean() > numbers.much_at_limit and varies:
            notes.append(f"{run.name}: the command stays at its largest value {100 * at_limit.mean():.0f} % of the time")
    length = sum(run.time[-1] for run in dataset.runs)
    turns = np.array([signal == "motor_speed" for signal in dataset.signals])  # steadily, too
    motion = max(
        float((np.where(turns, np.fmax.reduce(np.abs(run.measured), axis=0), run.extent) / dataset.noise).max())
        for run in dataset.runs
    )
    if length < numbers.shortest:
        notes.append(f"only {length:.2g} s of data: record at least 5 s with several starts and stops")
    if motion < numbers.least_motion:
        notes.append(
            "nothing moves beyond the noise: record a run that breaks away both ways, as `flexarm simulate --input square`"
        )
    return notes, length < numbers.shortest or motion < numbers.least_motion


def _stated_note(path: str, value: float) -> str:
    """Describe one condition that a recording states of the machine."""
    if path == PAYLOAD:
        return f"the arm carries the {value:g} kg that the recording states as its payload"
    return f"{path} is {value:g}, as the recording states"
