"""Recordings prepared once, for immediate replays of a changed arm."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import with_stated
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import Score, score
from flexarm_env.identify.replay.readings import bounded
from flexarm_env.identify.replay.replay import replay
from flexarm_env.identify.replay.run import Run
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Simulated:
    """Free replays of an arm.

    Attributes:
        readings: (samples, signals) by recording.
        error: rms over noise of all readings.
    """

    readings: dict[str, Floats]
    error: float


class Live:
    """Recordings prepared once for any number of replays.

    Args:
        arm: defines sensors and noise.
        recordings: of the machine.

    Attributes:
        signals: common to arm and recordings.

    Raises:
        InputError: for recordings that do not fit the arm.
    """

    def __init__(self, arm: Arm, recordings: Sequence[Recording]) -> None:
        reduced, self.data = prepare(arm, recordings)
        self.signals = list(self.data.signals)
        self._sensors = list(reduced.sensors)
        # The kernel lets go of Python's lock, so recordings run side by side.
        self._threads = ThreadPoolExecutor(max_workers=4, thread_name_prefix="flexarm-live")

    def simulate(self, arm: Arm) -> Simulated:
        """Replay all recordings freely."""
        known = self._reduced(arm)
        readings = list(self._threads.map(lambda run: self._replay(known, run), self.data.runs))
        pairs = list(zip(self.data.runs, readings, strict=True))
        total = sum(float(np.sum(bounded(run.errors(y, self.data.noise)) ** 2)) for run, y in pairs)
        count = sum(run.readings() for run in self.data.runs)
        return Simulated({run.name: y for run, y in pairs}, float(np.sqrt(total / count)))

    def held_out(self, arm: Arm) -> Score:
        """Compute the held-out errors of an arm; this takes about a second."""
        return score(self._reduced(arm), self.data)

    def _reduced(self, arm: Arm) -> Arm:
        return replace(arm, sensors={signal: arm.sensors[signal] for signal in self._sensors})

    def _replay(self, arm: Arm, run: Run) -> Floats:
        plant = with_stated(arm, run.stated).plant(self.data.interval)
        return replay(plant, run, self.data)
