"""Whether readings follow a sine of the arm's angle, or the angle turns by half a period and more from one to the next."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.run import Run

Floats = NDArray[np.float64]

#: Signals that show how far the hub turns, and whether one is a speed; the first that was measured counts.
SHOW_ANGLE = {"arm_angle": False, "motor_speed": True, "link_angle": False, "link_speed": True}


def follows_sine(arm: Arm, cycles: float, dataset: Dataset) -> bool:
    """Whether readings follow a sine of the arm's angle over some of the way.

    A sine that turns by more than half a period between two readings shows them an alias, which by chance is like any errors.

    Args:
        arm: the model.
        cycles: periods of the sine in 2π of the angle; infinite for an effect that is no sine, which is followed.
        dataset: the recordings.
    """
    if math.isinf(cycles):
        return True
    turns = turns_between_readings(arm, dataset)
    followed = turns[cycles * turns < math.pi]
    return float(followed.sum()) >= dataset.settings.screening.followed * float(turns.sum())


def turns_between_readings(arm: Arm, dataset: Dataset) -> Floats:
    """Compute by how much the hub turns from each reading to the next (readings,), rad; empty where no signal shows it."""
    shown = [name for name in SHOW_ANGLE if name in dataset.signals]
    return np.concatenate([_turns_of(arm, run, dataset, shown[0]) for run in dataset.runs]) if shown else np.zeros(0)


def _turns_of(arm: Arm, run: Run, dataset: Dataset, signal: str) -> Floats:
    values = run.measured[:, dataset.signals.index(signal)]
    there = ~np.isnan(values)
    changes = np.diff(values[there])
    if SHOW_ANGLE[signal]:
        ratio = arm.constants["drive"]["gear_ratio"] if signal == "motor_speed" else 1.0
        changes = values[there][1:] * np.diff(run.time[there]) / ratio
    return np.abs(changes)
