"""The noise of a sensor, estimated from its readings: standard deviation and resolution, at rest and in motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from flexarm_env.recordings.noise_windows import ORDER, WINDOW, Windows, cut_windows, together
from flexarm_env.recordings.resolution import distinct_readings, find_resolution

Floats = NDArray[np.float64]

#: Fewest windows of a state (rest or motion) in a recording that count on their own, and fewest of all.
FEWEST_IN_STATE, FEWEST = 30, 3
#: A window moves where its readings spread by more than this many standard deviations: 36 readings of noise spread by 4 to 5.
MOVES = 10.0
#: States agree with the least one within this many standard deviations of their difference.
AGREE = 3.0
#: Noise below this share of a step shows only as far as readings cross steps. Above it, rounding adds its variance whatever
#: the motion: the rest of the Fourier series of its error is below 1 % (Widrow and Kollár, Quantization Noise, 2008, ch. 4).
COARSE = 0.5
#: Steps that readings cross in a row: above the first, rounding errors of successive rows are independent; below the second,
#: readings count as still.
FAST, SLOW = 0.5, 0.15
#: Harmonics of the rounding error's series that are summed; the next ones are below 1e-4 of its variance.
HARMONICS = 60


@dataclass(frozen=True)
class Noise:
    """The noise of a sensor, in its unit.

    Attributes:
        deviation: standard deviation without the rounding to steps.
        resolution: step of the readings; 0 where none shows.
        rest: standard deviation of readings at rest, rounding included; None where too few rest.
        moving: the same in motion.
        at_most: standard deviation about a parabola in the median window, above that of any noise, white or not.
    """

    deviation: float
    resolution: float
    rest: float | None
    moving: float | None
    at_most: float

    @property
    def total(self) -> float:
        """Standard deviation of a reading: of the noise and of the rounding."""
        return float(np.hypot(self.deviation, self.resolution / 12**0.5))


@dataclass(frozen=True)
class Readings:
    """Readings of one sensor in one recording.

    Attributes:
        time: (n,) [s].
        values: (n,); NaN where nothing was measured.
        motion: (n,) the readings that a model predicts, which leave less motion beside the noise; None without a model.
    """

    time: Floats
    values: Floats
    motion: Floats | None = None

    def windows(self) -> Windows:
        """Cut the distinct readings into windows."""
        known = np.flatnonzero(np.isfinite(self.values))
        known = known[distinct_readings(self.values[known])]
        if self.motion is None:
            return cut_windows(self.time[known], self.values[known])
        known = known[np.isfinite(self.motion[known])]
        return cut_windows(self.time[known], self.values[known], self.motion[known])


def estimate_noise(runs: Sequence[Readings]) -> Noise | None:
    """Estimate the noise of a sensor from its readings in one recording or several.

    Noise is white, motion is not: the power of fourth differences near half the sampling rate is that of the noise, except in
    windows with events and at frequencies of vibrations, which are left out. Motion only adds power, so the least of rest and
    motion in all recordings counts, with all that agree with it.

    Args:
        runs: readings in each recording, in one unit.

    Returns:
        None for a signal that never changes, or that is too short.

    Example:
        >>> time = np.arange(0.0, 10.0, 0.01)
        >>> noise = np.random.default_rng(0).normal(0.0, 0.02, len(time))
        >>> found = estimate_noise([Readings(time, np.sin(3.0 * time) + noise)])
        >>> round(found.deviation, 2)
        0.02
    """
    known = [run.values[np.isfinite(run.values)] for run in runs]
    # A recording with few levels may show a multiple of the step.
    resolution = min((step for step in map(find_resolution, known) if step), default=0.0)
    cut = [windows for windows in (run.windows() for run in runs) if len(windows)]
    if sum(map(len, cut)) < FEWEST or all(np.ptp(values) == 0.0 for values in known if len(values)):
        return None
    variance, rest, moving = _variances(cut, resolution)
    if variance < (COARSE**2 + 1.0 / 12) * resolution**2:
        variance = _coarse_variance(cut, resolution)
    else:
        variance -= resolution**2 / 12
    at_most = np.hypot(np.sqrt(np.median(together(cut).scatter)), resolution / 12**0.5)
    return Noise(float(np.sqrt(max(variance, 0.0))), resolution, rest, moving, float(at_most))


def _variances(cut: Sequence[Windows], resolution: float) -> tuple[float, float | None, float | None]:
    """Estimate the variance of the readings, and their standard deviations at rest and in motion."""
    level = max(min(windows.variance() for windows in cut), resolution**2 / 12)
    moves = [windows.spread > MOVES * np.sqrt(level) for windows in cut]
    rests = [w.where(~m) for w, m in zip(cut, moves, strict=True)]
    moving = [w.where(m) for w, m in zip(cut, moves, strict=True)]
    variance = _least([*rests, *moving]) or together(cut).variance()
    return variance, _deviation(rests, resolution), _deviation(moving, resolution)


def _least(states: Sequence[Windows]) -> float | None:
    """Estimate the least variance of several states, with all that agree with it; None where none has enough windows."""
    found = [(state.variance(), state.uncertainty(), len(state)) for state in states if len(state) >= FEWEST_IN_STATE]
    if not found:
        return None
    least, scatter, _ = min(found, key=lambda one: one[0] * (1.0 + AGREE * one[1]))
    agreeing = [(v, n) for v, s, n in found if v <= least * (1.0 + AGREE * np.hypot(s, scatter))]
    return sum(v * n for v, n in agreeing) / sum(n for _, n in agreeing)


def _deviation(states: Sequence[Windows], step: float) -> float | None:
    """Estimate the standard deviation in one state: the least of all recordings, the rounding to steps at least."""
    known = [state.variance() for state in states if len(state) >= FEWEST_IN_STATE]
    return float(np.sqrt(max(min(known), step**2 / 12))) if known else None


def _coarse_variance(cut: Sequence[Windows], step: float) -> float:
    """Estimate the variance of noise that is smaller than a step, from how often readings cross steps."""
    crossed = [windows.spread / (step * (WINDOW + ORDER)) for windows in cut]
    fast = _least([windows.where(c > FAST) for windows, c in zip(cut, crossed, strict=True)])
    slow = together([windows.where(c < SLOW) for windows, c in zip(cut, crossed, strict=True)])
    if fast is not None or len(slow) < FEWEST:
        return (fast or together(cut).variance()) - step**2 / 12
    shown = float(np.mean(np.minimum(slow.power.mean(axis=1), 0.25 * step**2)))
    highest = COARSE * step
    if shown <= _shown_variance(0.0, step):
        return 0.0
    if shown >= _shown_variance(highest, step):
        return highest**2
    return float(brentq(lambda s: _shown_variance(s, step) - shown, 0.0, highest)) ** 2


def _shown_variance(deviation: float, step: float) -> float:
    """Compute the variance of rounded readings at a still place, as a mean over all places (Widrow and Kollár, 2008, ch. 4)."""
    harmonic = np.arange(1, HARMONICS + 1)
    error = (step / (np.pi * harmonic)) ** 2 / 2.0 * np.exp(-((2.0 * np.pi * harmonic * deviation / step) ** 2))
    missing = step**2 / 12 - (step / np.pi) ** 2 / 2.0 * np.sum(1.0 / harmonic**2)
    return float(deviation**2 + step**2 / 12 - error.sum() - missing)
