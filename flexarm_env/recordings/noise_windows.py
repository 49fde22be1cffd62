"""Power of a signal at high frequencies, window by window, over that of white noise.

Fourth differences in windows of 32, of which the bins near half the sampling rate are kept. Smooth motion vanishes there.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Differences of this order vanish for a cubic motion; this many make a window, short beside the time between two events.
ORDER, WINDOW = 4, 32
#: Bins from a fifth of the sampling rate, below which lies motion, up to the last below half of it.
BINS = slice(7, WINDOW // 2)
#: A window ends at a step over this many median ones.
GAP = 3.0
#: Power over that of the noise, as a mean over the bins, above which a window holds a start, a stop or a spike. Of windows of
#: noise, fewer than 1 % lie above.
EVENT = 2.5
#: Passes in which events are left out; the set of windows is then steady.
PASSES = 6
#: Bins further above the lowest quarter than this many standard deviations hold a vibration.
VIBRATES = 3.0
#: Variance of the mean power of a window of noise: nine bins under a Hann taper, windows that overlap by half.
UNCERTAINTY = 0.25


@dataclass(frozen=True)
class Windows:
    """Windows of a signal's readings.

    Attributes:
        power: (windows, bins) over that of white noise of variance 1: for such noise its mean is 1.
        spread: (windows,) of the readings, largest less smallest.
        scatter: (windows,) variance of the readings about a parabola, which holds all noise and fast motion.
    """

    power: Floats
    spread: Floats
    scatter: Floats

    def __len__(self) -> int:
        return len(self.power)

    def where(self, chosen: NDArray[np.bool_]) -> Windows:
        """Choose windows."""
        return Windows(self.power[chosen], self.spread[chosen], self.scatter[chosen])

    def variance(self) -> float:
        """Estimate the variance that all windows and bins have in common, that of the noise.

        The median over windows comes first. Bins of a vibration are left out, then windows of events, and the mean is taken.
        """
        level = np.median(self.power, axis=0) / np.log(2.0)
        tolerance = VIBRATES / (np.log(2.0) * np.sqrt(len(self)))
        flat = level <= np.quantile(level, 0.25) * (1.0 + tolerance)
        score, variance = self.power[:, flat].mean(axis=1), float(level[flat].mean())
        for _ in range(PASSES):
            quiet = score[score <= EVENT * variance]
            variance = float(quiet.mean()) if len(quiet) else variance
        return variance

    def uncertainty(self) -> float:
        """Compute the relative standard deviation of `variance` for white noise."""
        return float(np.sqrt(UNCERTAINTY / len(self)))


def together(parts: Sequence[Windows]) -> Windows:
    """Put the windows of several recordings together."""
    return Windows(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("power", "spread", "scatter")))


def cut_windows(time: Floats, readings: Floats, motion: Floats | None = None) -> Windows:
    """Cut readings into windows that overlap by half; sampling may be uneven, and gaps part windows.

    Args:
        time: (n,) [s].
        readings: (n,) finite.
        motion: (n,) predicted readings that are subtracted first; nothing if left out.
    """
    length = WINDOW + ORDER
    if len(readings) < length:
        return Windows(np.zeros((0, len(_unit_power()[BINS]))), np.zeros(0), np.zeros(0))
    rows = np.arange(0, len(readings) - length + 1, WINDOW // 2)[:, None] + np.arange(length)
    whole = np.diff(time[rows], axis=1).max(axis=1) <= GAP * np.median(np.diff(time))
    rows = rows[whole]
    left = readings if motion is None else readings - motion
    power = _power(_differences(time[rows], left[rows])) / _unit_power()
    return Windows(power[:, BINS], np.ptp(readings[rows], axis=1), _about_parabola(left[rows]))


def _about_parabola(readings: Floats) -> Floats:
    """Compute the variance (windows,) of readings (windows, length) about a parabola in each window."""
    length = readings.shape[1]
    powers, _ = np.linalg.qr(np.vander(np.linspace(-1.0, 1.0, length), 3))
    off = readings - (readings @ powers) @ powers.T
    variance: Floats = np.sum(off**2, axis=1) / (length - 3)
    return variance


def _power(differences: Floats) -> Floats:
    """Compute the power (windows, frequencies) of differences under a Hann taper."""
    power: Floats = np.abs(np.fft.rfft(differences * np.hanning(WINDOW + 2)[1:-1], axis=1)) ** 2
    return power


def _differences(times: Floats, readings: Floats) -> Floats:
    """Difference readings (windows, length) at any times by divided differences, their weights of unit norm."""
    count = readings.shape[1] - ORDER
    total, squares = np.zeros((2, len(readings), count))
    for i in range(ORDER + 1):
        own = times[:, i : i + count]
        weight = 1.0 / np.prod([own - times[:, j : j + count] for j in range(ORDER + 1) if j != i], axis=0)
        total += weight * readings[:, i : i + count]
        squares += weight**2
    return total / np.sqrt(squares)


@functools.cache
def _unit_power() -> Floats:
    """Compute the mean power (frequencies,) of white noise of variance 1, evenly sampled."""
    length = WINDOW + ORDER
    times = np.tile(np.arange(float(length)), (length, 1))
    power: Floats = _power(_differences(times, np.eye(length))).sum(axis=0)
    return power
