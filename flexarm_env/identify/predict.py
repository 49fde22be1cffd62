"""Replays of an arm against data: free, nudged (innovations form), and in windows from estimated states."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.data import WINDOW, Data
from flexarm_env.identify.observer import modal_gains, physical_gains
from flexarm_env.identify.run import Run, place
from flexarm_env.identify.scales import torque_scale
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant

Floats = NDArray[np.float64]

#: Torque noise assumed while estimating the states from which windows start, over the rms of the drive's torque.
WINDOW_LEVELS = (1e-4, 2e-3, 2e-2)
#: Drift of a held angle in one sample, over the noise of its sensor, at the torque noise that an arm states; at 1 Nm, where it
#: states none and is of the thesis's size.
HELD_DRIFT = 0.05


def replay(plant: Plant, run: Run, noise: Floats, physical: Floats | None = None) -> Floats:
    """Return the readings (samples, signals) of a replay from the run's start, nudged by physical gains if there are any."""
    place(plant, run, noise)
    if physical is None:
        return plant.replay(run.command, run.intervals, NO_GAINS, NOT_MEASURED)
    return plant.replay(run.command, run.intervals, modal_gains(plant, physical), run.measured)


def window_replay(plant: Plant, run: Run, observers: list[Floats], noise: Floats, interval: float, first: int = 0) -> Floats:
    """Return readings replayed freely in windows of 1 s from estimated states.

    The states come from replays that differ in how much they are nudged. In each window that one counts from which the
    window is met best: a stand-in for a smoother, which hysteresis (a hub at rest within its play) would lead astray.

    Args:
        plant: a compiled arm.
        run: the recording.
        observers: the kernel's gains of each replay.
        noise: (signals,) standard deviation of the readings.
        interval: sampling time [s].
        first: sample that is wanted first; windows before it are left empty.
    """
    length = max(round(WINDOW / interval), 10)
    starts = range(0, len(run.command), length)
    best = np.full(len(starts), np.inf)
    out = np.empty_like(run.measured)
    command = plant.delayed(run.command)
    for gains in observers:
        place(plant, run, noise)
        for w, start in enumerate(starts):
            part = slice(start, start + length + 1)
            intervals = run.intervals[part] if len(run.intervals) else run.intervals
            state = plant.state.copy()
            if start + length > first or not len(gains):
                free = plant.play(command[part], intervals, NO_GAINS, NOT_MEASURED)[:length]
                inside = slice(start, start + len(free))
                error = float(np.sum(((run.measured[inside] - free) / noise) ** 2))
                if error < best[w] or not np.isfinite(best[w]):
                    out[inside], best[w] = free, error if np.isfinite(error) else np.inf
            if len(gains):
                plant.state[:] = state
                plant.play(command[part], intervals, gains, run.measured[part])
    return out


def window_observers(arm: Arm, plant: Plant, data: Data, levels: Sequence[float] = WINDOW_LEVELS) -> list[Floats]:
    """Return the kernel's gains of the replays that estimate the states from which windows start."""
    scale, own = torque_scale(arm, data.runs), arm.constants["drive"]["torque_noise"]
    noises = sorted({max(level * scale, own) for level in levels})
    return [NO_GAINS, *(modal_gains(plant, observer_gains(arm, plant, data, noise)) for noise in noises)]


def observer_gains(arm: Arm, plant: Plant, data: Data, torque_noise: float) -> Floats:
    """Return the physical gains (modes, states, signals) of a replay that is nudged as a torque noise [Nm] asks for."""
    # in steps of 64: an arm's size matters here, not how hard it is driven
    whole = arm.constants["drive"]["torque_noise"] or 64.0 ** round(math.log(data.scales["N*m"], 64.0))
    held_drift = HELD_DRIFT * min(torque_noise / whole, 1.0)
    return physical_gains(plant, data.noise, torque_noise, data.interval, held_drift)
