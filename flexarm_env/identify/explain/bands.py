"""Errors by frequency band."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.explain.comparison import Replay, Row
from flexarm_env.identify.replay.dataset import Dataset

Floats = NDArray[np.float64]


def band_rows(replays: Sequence[Replay], signal: str, noise: float, dataset: Dataset) -> Iterator[Row]:
    """Measure a signal's errors over noise by frequency: white noise alone gives 1 in every band.

    Bands end at half the rate of the slowest recording of the signal.
    """
    series = [at_own_rate(one, signal, dataset.interval) for one in replays]
    nyquist = 0.5 / max(interval for _, interval in series)
    edges = [edge for edge in dataset.settings.explaining.bands if edge < nyquist] + [nyquist]
    power = np.zeros(len(edges) - 1)
    count = np.zeros(len(edges) - 1)
    for error, interval in series:
        spectrum = np.abs(np.fft.rfft(error)) ** 2 / len(error)
        frequency = np.fft.rfftfreq(len(error), interval)
        place = np.clip(np.searchsorted(edges, frequency, side="right") - 1, 0, len(power) - 1)
        np.add.at(power, place, spectrum)
        np.add.at(count, place, 1.0)
    for low, high, p, c in zip(edges, edges[1:], power, count, strict=False):
        band_error = float(np.sqrt(p / c)) / noise if c else float("nan")
        yield Row("all", signal, f"{low:g}-{high:g} Hz", band_error, float("nan"), float("nan"), int(c))


def at_own_rate(one: Replay, signal: str, interval: float) -> tuple[Floats, float]:
    """Select the errors (readings,) of a signal where it was measured, and give their usual interval [s].

    Gaps are closed: a spectrum is that of the pieces, one after another.

    Args:
        one: a recording beside its replay.
        signal: name.
        interval: of the samples [s].
    """
    rows = np.flatnonzero(~np.isnan(one.measured[signal]))
    step = float(np.median(np.diff(rows))) if len(rows) > 1 else 1.0
    return (one.measured[signal] - one.windows[signal])[rows], step * interval
