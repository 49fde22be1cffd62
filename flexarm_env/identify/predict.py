"""Replays of an arm against data: free, nudged (innovations form), and in windows from estimated states."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.data import WINDOW, Data, Run, place
from flexarm_env.identify.observer import modal_gains, physical_gains
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant

Floats = NDArray[np.float64]

#: Torque noise assumed while estimating the states from which windows start, over the rms of the drive's torque.
WINDOW_NOISE = 2e-3


def torque_scale(arm: Arm, data: Data) -> float:
    """Return the rms of the torque that the command gives at the hub [Nm]."""
    drive = arm.constants["drive"]
    per_command = drive["gear_ratio"] * drive["torque_constant"]
    if arm.input == "voltage":
        per_command /= drive["resistance"]
    return per_command * max(float(np.sqrt(np.mean([np.mean(run.command**2) for run in data.runs]))), 1e-9)


def replay(plant: Plant, run: Run, physical: Floats | None = None) -> Floats:
    """Return the readings (samples, signals) of a replay from the run's start, nudged by physical gains if there are any."""
    place(plant, run)
    if physical is None:
        return plant.replay(run.command, run.intervals, NO_GAINS, NOT_MEASURED)
    return plant.replay(run.command, run.intervals, modal_gains(plant, physical), run.measured)


def window_replay(plant: Plant, run: Run, gains: Floats, interval: float) -> Floats:
    """Return readings replayed freely in windows of 1 s, each from the state that a nudged replay has reached."""
    length = max(int(round(WINDOW / interval)), 10)
    out = np.empty_like(run.measured)
    place(plant, run)
    count = len(run.command)
    command = plant.delayed(run.command)
    start = 0
    while start < count:
        stop = min(start + length, count)
        end = min(stop + 1, count)
        part = slice(start, end)
        intervals = run.intervals[part] if len(run.intervals) else run.intervals
        state = plant.state.copy()
        out[start:stop] = plant.play(command[part], intervals, NO_GAINS, NOT_MEASURED)[: stop - start]
        plant.state[:] = state
        plant.play(command[part], intervals, gains, run.measured[part])
        start = stop
    return out


def window_gains(arm: Arm, plant: Plant, data: Data) -> Floats:
    """Return the kernel's gains for estimating the states from which windows start."""
    noise = max(WINDOW_NOISE * torque_scale(arm, data), arm.constants["drive"].get("torque_noise", 0.0))
    return modal_gains(plant, physical_gains(plant, data.noise, noise, data.interval))
