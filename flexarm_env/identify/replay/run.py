"""One recording as arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.experiments.stated import Stated
from flexarm_env.identify.replay.initial_state import Start
from flexarm_env.identify.replay.loop import Loop
from flexarm_env.identify.replay.readings import count_of, errors_of, extent, measured_time

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Run:
    """One recording as arrays.

    Attributes:
        name: of the recording.
        time: (samples,) [s].
        command: (samples,) [A or V].
        measured: (samples, signals), SI units; NaN where nothing was measured.
        intervals: (samples,) times to the next sample [s] where sampling is uneven, else empty.
        train: (samples,) true where calibrations see the sample.
        start: evidence of its first samples on its initial state.
        stated: what the recording states of the machine, a payload [kg] or values of constants.
        loop: the control loop in which it was recorded, where that is known.
        loop_note: on the control law, or on the reason why there is no loop; "" where none is stated.
    """

    name: str
    time: Floats
    command: Floats
    measured: Floats
    intervals: Floats
    train: NDArray[np.bool_]
    start: Start
    stated: Stated = ()
    loop: Loop | None = None
    loop_note: str = ""

    def errors(self, modelled: Floats, sigma: Floats | float = 1.0, rows: slice = slice(None)) -> Floats:
        """Compute measured less modelled readings (rows, signals) over sigma; 0 where nothing was measured."""
        return errors_of(self.measured[rows], modelled, sigma)

    def readings(self, rows: NDArray[np.bool_] | slice = slice(None)) -> int:
        """Count the readings in some samples."""
        return count_of(self.measured[rows])

    @property
    def measured_time(self) -> Floats:
        """The time (samples,) [s] in which anything was measured, from the first sample to each."""
        return measured_time(self.time, self.measured)

    @property
    def extent(self) -> Floats:
        """The range (signals,) from the smallest to the largest reading, SI units."""
        return extent(self.measured)

    def first(self, count: int) -> Run:
        """Cut the run down to its first samples."""
        return replace(
            self,
            time=self.time[:count],
            command=self.command[:count],
            measured=self.measured[:count],
            intervals=self.intervals[:count],
            train=self.train[:count],
            loop=None if self.loop is None else self.loop.first(count),
        )
