"""The readings of one signal in one recording, with the step and the noise that they show."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.settings import Inspecting
from flexarm_env.recordings.noise import Noise, Readings, estimate_noise
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


#: Signals of the hub, which are readings of one motion: where one of them rests, so does the other.
HUB = ("arm_angle", "motor_speed")


@dataclass(frozen=True)
class Series:
    """Readings of a signal, those left out that were not measured.

    Attributes:
        rows: (n,) samples of the recording that they stand in.
        values: (n,) in the signal's unit.
        step: smallest change between two readings in a row; 0 where none changes.
        noise: standard deviation of a reading, of noise and rounding; at least that of rounding to the step.
    """

    rows: Integers
    values: Floats
    step: float
    noise: float

    def __len__(self) -> int:
        return len(self.values)

    @functools.cached_property
    def changes(self) -> Floats:
        """Changes (n - 1,) from one reading to the next."""
        return np.diff(self.values)

    @property
    def flicker(self) -> float:
        """Share of readings at which the signal turns back at once: two thirds for white noise, next to none for a motion."""
        return float(np.mean(self.changes[1:] * self.changes[:-1] < 0.0)) if len(self) > 2 else 0.0

    def repeats_at_rest(self, numbers: Inspecting) -> float:
        """Share of readings that repeat where noise is all that moves them, in the middle of a step: the largest at rest."""
        own = math.sqrt(max(self.noise**2 - (numbers.from_rounding * self.step) ** 2, 0.0))
        return math.erf(0.5 * self.step / (math.sqrt(2.0) * own)) if own else 1.0

    def runs(self) -> tuple[Integers, Integers]:
        """Find stretches of equal readings without a gap; return the index of the first reading of each, and their lengths."""
        steps = np.diff(self.rows)
        gaps = steps > 2 * np.median(steps) if len(steps) else steps > 0
        starts = np.flatnonzero(np.r_[True, (self.changes != 0.0) | gaps]).astype(np.int64)
        return starts, np.diff(np.r_[starts, len(self)]).astype(np.int64)

    def stands_still(self, rows: Integers, numbers: Inspecting) -> bool:
        """Whether the signal mostly repeats its readings at some samples, as without noise at rest."""
        same = self.changes[np.isin(self.rows[1:], rows)] == 0.0
        return not same.size or float(same.mean()) > numbers.most_changing

    def most_repeats(self, elsewhere: NDArray[np.bool_], numbers: Inspecting) -> float:
        """Compute the largest share of repeated readings in any stretch of the signal.

        Args:
            elsewhere: (n,) readings that count.
            numbers: of the inspection.
        """
        length = (len(self) - 1) // numbers.stretches
        pieces = length * numbers.stretches
        repeated, counted = (self.changes == 0.0) & elsewhere[1:], elsewhere[1:]
        sums = [part[:pieces].reshape(numbers.stretches, length).sum(axis=1) for part in (repeated, counted)]
        enough = sums[1] >= numbers.fewest_at_rail
        shares = sums[0][enough] / sums[1][enough]
        return float(np.clip(shares.max() if shares.size else 1.0, numbers.least_repeats, 1.0))


@dataclass(frozen=True)
class Inspected:
    """A recording and the noise of its signals.

    Attributes:
        recording: as the checks before have mended it.
        noise: by signal, of the readings as they were read; None where they show none.
    """

    recording: Recording
    noise: Mapping[str, Noise | None]

    @classmethod
    def of(cls, recording: Recording) -> Inspected:
        """Estimate the noise of every signal of a recording."""
        pairs = ((signal, Readings(recording.time, values)) for signal, values in recording.signals.items())
        return cls(recording, {signal: estimate_noise([readings]) for signal, readings in pairs})

    def series(self, signal: str, numbers: Inspecting) -> Series:
        """Take the readings of a signal out of the recording."""
        rows = np.flatnonzero(np.isfinite(self.recording.signals[signal]))
        values = self.recording.signals[signal][rows]
        changes = np.abs(np.diff(values))
        real = changes[changes > numbers.rounding * np.ptp(values)] if len(values) > 1 else changes
        step = float(real.min()) if real.size else 0.0
        found = self.noise[signal]
        return Series(rows, values, step, max(found.total if found else 0.0, step * numbers.from_rounding))


def partners(signal: str, series: Mapping[str, Series]) -> list[Series]:
    """List the signals that rest where a signal does: those of the hub for one of the hub, else all others."""
    return [one for other, one in series.items() if other != signal and (signal not in HUB or other in HUB)]
