"""Frequency of a vibration as a signal shows it, in a stretch or at each moment, without knowing the arm's matrices.

Within a stretch in which the hub only moves or only sticks, a signal is a sum of damped sines and exponentials. A matrix
pencil (Hua and Sarkar, IEEE Trans. ASSP 38 (1990) 814) finds them from the samples, and a trend does not disturb it, as it
does the phase of an analytic signal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import svd

Floats = NDArray[np.float64]

#: Samples are taken at this distance [s]: a sixth of the period of the second mode.
SPACING = 0.006
#: Sines and exponentials in a stretch, at most: two vibrations, two real modes, a constant, and one to spare.
ORDER = 8
#: Singular values below this share of the largest are rounding.
ROUNDING = 1e-7
#: What grows by more than this over a stretch is no motion of an arm, but the edge of a stick.
LARGEST_GROWTH = 1e9
#: Fundamentals lie within, second modes above, the hub's slow motion below [Hz].
BAND = (0.8, 16.0)


@dataclass(frozen=True)
class Vibration:
    """A damped sine: frequency [Hz], amplitude at the start [unit of the signal], decay rate [1/s]."""

    frequency: float
    amplitude: float
    decay: float


NONE = Vibration(float("nan"), 0.0, float("nan"))


def vibration(time: Floats, signal: Floats, start: float, stop: float, band: tuple[float, float] = BAND) -> Vibration:
    """Return the strongest vibration of a signal between two times.

    Args:
        time: (samples,) [s], even.
        signal: (samples,).
        start: [s].
        stop: [s].
        band: frequencies that count [Hz].

    Returns:
        The vibration within the band that has the most power over the stretch; frequency nan if there is none.
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
    """Poles of the samples (up to ORDER,)."""
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
    """Return the middles of windows [s] and the frequency in each [Hz], nan where nothing vibrates."""
    starts = np.arange(time[0], time[-1] - window, every)
    found = np.array([vibration(time, signal, t, t + window, band).frequency for t in starts])
    return starts + 0.5 * window, found
