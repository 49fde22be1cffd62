"""Replays of an arm against a dataset: free, observer-corrected (innovations form), and in windows from estimated states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.closed_loop import LoopReplay, play_loop
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.loop import Loop
from flexarm_env.identify.replay.observer import modal_gains, observer_gains
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.replay.start_fit import StartFit
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant

Floats = NDArray[np.float64]


def replay(plant: Plant, run: Run, dataset: Dataset, gains: Floats | None = None, start: StartFit | None = None) -> Floats:
    """Replay a run from its initial state.

    Args:
        plant: a compiled arm.
        run: the recording.
        dataset: to which the run belongs.
        gains: physical observer gains (modes, states, signals) for a corrected replay; None for a free one.
        start: the initial state; fitted if left out.

    Returns:
        The readings (samples, signals), SI units.
    """
    stretch = dataset.stretch(run)
    stretch.place(plant, stretch.fit(plant) if start is None else start)
    if gains is None:
        return plant.replay(run.command, run.intervals, NO_GAINS, NOT_MEASURED)
    return plant.replay(run.command, run.intervals, modal_gains(plant, gains), run.measured)


def loop_replay(plant: Plant, run: Run, loop: Loop, dataset: Dataset) -> LoopReplay:
    """Replay a run from its initial state in closed loop.

    Args:
        plant: a compiled arm.
        run: the recording.
        loop: its control law and reference.
        dataset: to which the run belongs.
    """
    stretch = dataset.stretch(run, loop)
    stretch.place(plant, stretch.fit(plant))
    return play_loop(plant, loop, run.intervals)


def whole_replay(plant: Plant, run: Run, dataset: Dataset) -> Floats:
    """Replay a run once from its start, in closed loop where that is known: readings (samples, signals), SI units."""
    return replay(plant, run, dataset) if run.loop is None else loop_replay(plant, run, run.loop, dataset).readings


@dataclass(frozen=True)
class WindowStates:
    """States of an arm at the beginning of one window, under each of several observers.

    Attributes:
        window: its number.
        physical: (observers, states).
    """

    window: int
    physical: Floats


def window_length(dataset: Dataset) -> int:
    """Count the samples of a window."""
    numbers = dataset.settings.preparation
    return max(round(numbers.window / dataset.interval), numbers.least_window_samples)


def states_before(plant: Plant, run: Run, dataset: Dataset, observers: Sequence[Floats], first: int) -> WindowStates:
    """Estimate the states of an arm one window before that of a sample, from replays under observers.

    Args:
        plant: a compiled arm.
        run: the recording.
        dataset: to which the run belongs.
        observers: the kernel's gains of each replay.
        first: the sample.
    """
    length = window_length(dataset)
    window = max(first // length - 1, 0)
    part, states = slice(0, window * length + 1), []
    stretch, command = dataset.stretch(run), run.command
    start = stretch.fit(plant)
    for gains in observers:
        stretch.place(plant, start)
        intervals = run.intervals[part] if len(run.intervals) else run.intervals
        plant.play(plant.delayed(command)[part], intervals, gains, run.measured[part])
        states.append(plant.physical())
    return WindowStates(window, np.array(states))


def window_replay(
    plant: Plant,
    run: Run,
    dataset: Dataset,
    observers: Sequence[Floats],
    first: int = 0,
    start: StartFit | WindowStates | None = None,
) -> Floats:
    """Replay a run freely in windows from estimated states.

    The states come from replays under several observers. Each window starts from the state that meets the window best: a
    stand-in for a smoother, which hysteresis (a hub at rest within its backlash) would mislead.

    Args:
        plant: a compiled arm.
        run: the recording.
        dataset: to which the run belongs.
        observers: the kernel's gains of each replay.
        first: first sample of interest; windows before it are left empty.
        start: the initial state; fitted if left out. Or states under each observer of an arm that is nearly the same, later on.

    Returns:
        The readings (samples, signals), SI units.
    """
    length = window_length(dataset)
    begins = range(0, len(run.command), length)
    best = np.full(len(begins), np.inf)
    out = np.empty_like(run.measured)
    later = start if isinstance(start, WindowStates) and start.physical.shape[1] == plant.states else None
    stretch = dataset.stretch(run)
    stretch.place(plant, start if isinstance(start, StartFit) else stretch.fit(plant))
    began, command = plant.state.copy(), plant.delayed(run.command)
    for number, gains in enumerate(observers):
        plant.state[:] = began
        if later is not None:
            sample = later.window * length
            plant.place(later.physical[number], float(command[max(sample - 1, 0)]), float(run.time[sample]))
        for w, begin in list(enumerate(begins))[0 if later is None else later.window :]:
            part = slice(begin, begin + length + 1)
            intervals = run.intervals[part] if len(run.intervals) else run.intervals
            state = plant.state.copy()
            if begin + length > first or not len(gains):
                free = plant.play(command[part], intervals, NO_GAINS, NOT_MEASURED)[:length]
                inside = slice(begin, begin + len(free))
                error = float(np.sum(run.errors(free, dataset.noise, inside) ** 2))
                if error < best[w] or not np.isfinite(best[w]):
                    out[inside], best[w] = free, error if np.isfinite(error) else np.inf
            if len(gains):
                plant.state[:] = state
                plant.play(command[part], intervals, gains, run.measured[part])
    return out


def window_observers(arm: Arm, plant: Plant, dataset: Dataset, levels: Sequence[float] | None = None) -> list[Floats]:
    """Compute the kernel's gains of the replays that give windows their initial states.

    Args:
        arm: the model.
        plant: the same, compiled.
        dataset: the recordings.
        levels: of process noise, over the rms torque of the drive; those of `process_noise.windows` if left out.

    Returns:
        No gains first, then those of each level.
    """
    levels = dataset.settings.process_noise.windows if levels is None else levels
    scale, own = torque_scale(arm, dataset.runs), arm.constants["drive"]["torque_noise"]
    noises = sorted({max(level * scale, own) for level in levels})
    return [NO_GAINS, *(modal_gains(plant, observer_gains(arm, plant, dataset, noise)) for noise in noises)]
