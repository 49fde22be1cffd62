"""How far a measured signal agrees with a modelled one: factor, lag and share explained, whatever the drift."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from flexarm_env.identify.settings import MotionFaults

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Agreement:
    """A measured signal as a multiple of a modelled one.

    Attributes:
        gain: the measured over the modelled.
        lag: time by which the measured is late [s].
        share: of the measured signal's variance that the multiple explains.
        power: variance of the measured signal, in its unit squared.
    """

    gain: float
    lag: float
    share: float
    power: float = 0.0

    @property
    def share_at_one(self) -> float:
        """Share of the measured variance that the model explains with a gain of 1."""
        return self.share / self.gain * (2.0 - 1.0 / self.gain) if self.gain > 0.0 else 0.0

    def explains_more_than(self, other: Agreement, numbers: MotionFaults) -> bool:
        """Whether it leaves a small part of what another leaves."""
        return 1.0 - self.share < numbers.unexplained * (1.0 - other.share)

    def is_within(self, factor: float) -> bool:
        """Whether the gain is 1 within a factor."""
        return 1.0 / factor < self.gain < factor


NOTHING_IN_COMMON = Agreement(0.0, 0.0, 0.0)


def agreement(measured: Floats, modelled: Floats, cell: float, numbers: MotionFaults) -> Agreement:
    """Fit a gain by least squares in windows, each with an offset and a drift of its own.

    Args:
        measured: (cells,).
        modelled: (cells,).
        cell: length of a cell [s].
        numbers: of the method.
    """
    y, p = (in_windows(part, cell, numbers) for part in (measured, modelled))
    known = np.isfinite(y).all(axis=1) & np.isfinite(p).all(axis=1)
    y, p = y[known], p[known]
    own, model, both = float((y * y).sum()), float((p * p).sum()), float((y * p).sum())
    if not own * model > 0.0:
        return NOTHING_IN_COMMON
    return Agreement(both / model, 0.0, both / own * both / model, own / y.size)


def in_windows(values: Floats, cell: float, numbers: MotionFaults) -> Floats:
    """Cut values (cells,) into windows (windows, cells), each without its mean and slope."""
    length = min(max(round(numbers.window / cell), numbers.least_window_cells), len(values))
    count = len(values) // length
    return _without_line(values[: count * length].reshape(count, length))


def agreement_late(measured: Floats, modelled: Floats, cell: float, numbers: MotionFaults) -> Agreement:
    """Fit a gain at the lag at which a signal agrees best: at none where it has the model's shape without.

    Half a period late, a vibration looks turned round: a lag with a positive gain that explains much more than none comes first.
    """
    at_once = agreement(measured, modelled, cell, numbers)
    if at_once.share > numbers.same_shape and at_once.gain > 0.0:
        return at_once
    tried = [at_once]
    for lag in _likely_lags(measured, modelled, cell, numbers):
        best, step = agreement_at(measured, modelled, lag, cell, numbers), numbers.lag_step
        while step > numbers.lag_resolution:
            sides = (agreement_at(measured, modelled, best.lag + side * step, cell, numbers) for side in (-1, 1))
            better = max(sides, key=lambda one: one.share)
            if better.share > best.share:
                best = better
            else:
                step *= 0.5
        tried.append(best)
    later = [one for one in tried if one.gain > 0.0 and one.explains_more_than(at_once, numbers)]
    return max(later or tried, key=lambda one: one.share)


def agreement_at(measured: Floats, modelled: Floats, lag: float, cell: float, numbers: MotionFaults) -> Agreement:
    """Fit a gain at a lag [s]."""
    return replace(agreement(measured, delayed(modelled, lag / cell), cell, numbers), lag=lag)


def agreement_filtered(measured: Floats, modelled: Floats, cell: float, numbers: MotionFaults) -> Agreement:
    """Fit a gain behind the first-order filter, of any time constant up to the longest lag, at which a signal agrees best."""
    found = minimize_scalar(
        lambda log: -agreement(measured, filtered(modelled, np.exp(log) / cell), cell, numbers).share,
        bounds=(np.log(numbers.lag_resolution), np.log(numbers.longest_lag)),
        method="bounded",
    )
    return agreement(measured, filtered(modelled, float(np.exp(found.x)) / cell), cell, numbers)


def filtered(values: Floats, cells: float) -> Floats:
    """Pass values (cells,) through a first-order filter whose time constant is a number of cells; gaps are bridged."""
    from scipy.signal import lfilter  # half a second, which recordings whose signals agree need not wait for

    known = np.isfinite(values)
    place, share = np.arange(len(values)), 1.0 - np.exp(-1.0 / cells)
    bridged = np.interp(place, place[known], values[known]) if known.any() else values
    passed = lfilter([share], [1.0, share - 1.0], bridged, zi=[(1.0 - share) * bridged[0]])[0]
    return np.where(known, passed, np.nan)


def delayed(values: Floats, cells: float) -> Floats:
    """Delay values (cells,) by a number of cells, or advance them; NaN where nothing is known."""
    place = np.arange(len(values))
    return np.interp(place - cells, place, values, left=np.nan, right=np.nan)


def _likely_lags(measured: Floats, modelled: Floats, cell: float, numbers: MotionFaults) -> list[float]:
    """List the lags [s] of the largest and the smallest correlation."""
    length = len(measured)
    widest = round(min(numbers.longest_lag, numbers.longest_lag_share * length * cell) / cell)
    y, p = (np.fft.rfft(_fast_part(part, round(numbers.window / cell)), 2 * length) for part in (measured, modelled))
    correlation = np.fft.irfft(y * np.conj(p), 2 * length)
    lags = np.concatenate([np.arange(widest + 1), np.arange(-widest, 0)])
    found = correlation[lags]
    return [float(lags[place]) * cell for place in {int(np.argmax(found)), int(np.argmin(found))}]


def _fast_part(values: Floats, length: int) -> Floats:
    """Subtract a moving mean; what is not known or not finite becomes zero."""
    known = np.where(np.isfinite(values), values, 0.0)
    box = np.ones(min(length, len(values)))
    return known - np.convolve(known, box, "same") / np.convolve(np.ones(len(values)), box, "same")


def _without_line(windows: Floats) -> Floats:
    """Remove mean and slope from windows (windows, cells)."""
    line = np.arange(windows.shape[1]) - 0.5 * (windows.shape[1] - 1)
    level = windows - windows.mean(axis=1, keepdims=True)
    return np.asarray(level - np.outer(level @ line, line) / (line @ line))
