"""Frequency of a vibration in a signal, over an interval or over time, estimated without the arm's matrices.

While the hub only moves or only sticks, a signal is a sum of damped sines and exponentials. A matrix pencil (Hua and Sarkar,
IEEE Trans. ASSP 38 (1990) 814) estimates them from the samples. Unlike the phase of an analytic signal it is not disturbed
by a trend.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import svd

Floats = NDArray[np.float64]

#: Sampling interval [s]: a sixth of the period of the second mode.
SPACING = 0.006
#: Largest number of poles in an interval: two vibrations, two real modes, a constant, and one to spare.
ORDER = 8
#: Singular values below this share of the largest are rounding errors.
ROUNDING = 1e-7
#: A component that grows by more than this over an interval is no motion of an arm, but a transition to sticking.
LARGEST_GROWTH = 1e9
#: Band of the fundamentals [Hz]: second modes lie above, the hub's slow motion below.
BAND = (0.8, 16.0)


@dataclass(frozen=True)
class Vibration:
    """A damped sine: frequency [Hz], amplitude at the start [unit of the signal], decay rate [1/s]."""

    frequency: float
    amplitude: float
    decay: float


NONE = Vibration(float("nan"), 0.0, float("nan"))


def vibration(time: Floats, signal: Floats, start: float, stop: float, band: tuple[float, float] = BAND) -> Vibration:
    """Estimate the strongest vibration of a signal between two times.

    Args:
        time: (samples,) [s], equally spaced.
        signal: (samples,).
        start: [s].
        stop: [s].
        band: range of frequencies [Hz].

    Returns:
        The vibration within the band with the most power over the interval; frequency nan if there is none.
    """
    stride = max(round(SPACING / (time[1] - time[0])), 1)
    inside = np.flatnonzero((time >= start - 1e-9) & (time < stop - 1e-9))[::stride]
    if len(inside) < 3 * ORDER:
        return NONE
    values, spacing = signal[inside], stride * (time[1] - time[0])
    if np.ptp(values) <= 1e-12:
        return NONE
    poles = _poles(values)
    if not len(poles):
        return NONE
    powers = poles[None, :] ** np.arange(len(values))[:, None]
    sizes = np.linalg.lstsq(powers, values.astype(complex), rcond=None)[0]
    rates = np.log(poles) / spacing
    best, most = NONE, 0.0
    for rate, size, power in zip(rates, sizes, (np.abs(powers * sizes) ** 2).sum(axis=0), strict=True):
        frequency = rate.imag / (2.0 * np.pi)
        if band[0] <= frequency <= band[1] and power > most:
            best, most = Vibration(float(frequency), float(2.0 * abs(size)), float(-rate.real)), power
    return best


def _poles(values: Floats) -> NDArray[np.complex128]:
    """Estimate the poles of the samples (up to ORDER,)."""
    width = len(values) // 3
    hankel = np.lib.stride_tricks.sliding_window_view(values, width + 1)
    _, sizes, right = svd(hankel, full_matrices=False)
    order = min(ORDER, int(np.sum(sizes > ROUNDING * sizes[0])))
    basis = right[:order].T
    found = np.linalg.eigvals(np.linalg.lstsq(basis[:-1], basis[1:], rcond=None)[0])
    size = np.abs(found)
    return np.asarray(found[(size > 1e-3) & (size ** len(values) < LARGEST_GROWTH)], dtype=complex)


def over_time(
    time: Floats, signal: Floats, window: float, every: float, band: tuple[float, float] = BAND
) -> tuple[Floats, Floats]:
    """Estimate the frequency in each window [Hz], nan without vibration; return the windows' middles [s] first."""
    starts = np.arange(time[0], time[-1] - window, every)
    found = np.array([vibration(time, signal, t, t + window, band).frequency for t in starts])
    return starts + 0.5 * window, found
