"""One recording as arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.start import Start, place_at_start
from flexarm_env.plant.plant import Plant

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Run:
    """One recording as arrays.

    Attributes:
        name: of the recording.
        time: (samples,) [s].
        command: (samples,) [A or V].
        measured: (samples, signals), SI units.
        intervals: (samples,) times to the next sample [s] where sampling is uneven, else empty.
        train: (samples,) what fits see.
        start: what its first samples say of its state.
        payload: known mass at the tip [kg], beside what the arm has there.
    """

    name: str
    time: Floats
    command: Floats
    measured: Floats
    intervals: Floats
    train: NDArray[np.bool_]
    start: Start
    payload: float = 0.0


def cut(run: Run, count: int) -> Run:
    """Return a run's first samples."""
    return replace(
        run,
        time=run.time[:count],
        command=run.command[:count],
        measured=run.measured[:count],
        intervals=run.intervals[:count],
        train=run.train[:count],
    )


def place(plant: Plant, run: Run, noise: Floats) -> None:
    """Put the plant where a run starts."""
    place_at_start(plant, run.start, run.command, run.intervals, run.measured, noise)
