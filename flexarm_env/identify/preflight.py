"""What to know of recordings before a model is held against them."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.data import Data

SHORTEST = 1.0
#: Motion below this many standard deviations of a signal's noise says nothing.
LEAST_MOTION = 8.0


def preflight(arm: Arm, data: Data) -> tuple[list[str], bool]:
    """Return what a person should know, a line each, and whether the data are too poor to judge the arm."""
    notes = []
    for run in data.runs:
        if run.payload:
            notes.append(f"{run.name}: the arm carries the {run.payload:g} kg that the recording states as its payload")
        if len(run.intervals):
            notes.append(f"{run.name}: sampled unevenly, {run.intervals.min():.4g} to {run.intervals.max():.4g} s")
        at_limit = np.abs(run.command) >= 0.999 * np.abs(run.command).max()
        if at_limit.mean() > 0.3 and np.ptp(run.command) > 0.0 and len(np.unique(run.command)) > 4:
            notes.append(f"{run.name}: the command stands at its limit {100 * at_limit.mean():.0f} % of the time")
    length = sum(run.time[-1] for run in data.runs)
    turns = np.array([signal == "motor_speed" for signal in data.signals])  # steadily, too
    motion = max(
        float((np.where(turns, np.abs(run.measured).max(axis=0), np.ptp(run.measured, axis=0)) / data.noise).max())
        for run in data.runs
    )
    if length < SHORTEST:
        notes.append(f"only {length:.2g} s of data: record at least 5 s with several starts and stops")
    if motion < LEAST_MOTION:
        notes.append(
            "nothing moves beyond the noise: record a run that breaks away both ways, as `flexarm simulate --input square`"
        )
    return notes, length < SHORTEST or motion < LEAST_MOTION
