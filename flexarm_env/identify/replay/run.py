"""One recording as arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.replay.initial_state import Start
from flexarm_env.identify.replay.loop import Loop

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
        train: (samples,) true where calibrations see the sample.
        start: evidence of its first samples on its initial state.
        payload: known mass at the tip [kg], beside the arm's own.
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
    payload: float = 0.0
    loop: Loop | None = None
    loop_note: str = ""

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
