"""Errors of a model against readings. A reading that is absent (NaN) weighs nothing and is not counted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.settings import FAILED_ERROR

Floats = NDArray[np.float64]


def errors_of(measured: Floats, modelled: Floats, sigma: Floats | float = 1.0) -> Floats:
    """Compute measured less modelled readings over sigma; 0 where nothing was measured.

    Args:
        measured: (…, signals) or (samples,), NaN where nothing was measured.
        modelled: of the same shape.
        sigma: (signals,) or one number, in the unit of the readings.
    """
    with np.errstate(over="ignore"):  # a replay that failed leaves any range: its error is infinite
        errors = (measured - modelled) / sigma
    errors[np.isnan(measured)] = 0.0
    return np.asarray(errors)


def bounded(errors: Floats) -> Floats:
    """Replace errors over the noise that are not finite, of a failed replay, by large ones."""
    if np.isfinite(errors).all():
        return errors
    return np.nan_to_num(errors, nan=FAILED_ERROR, posinf=FAILED_ERROR, neginf=-FAILED_ERROR)


def count_of(measured: Floats) -> int:
    """Count the readings that are there."""
    return measured.size - int(np.count_nonzero(np.isnan(measured)))


def share_of(measured: Floats) -> Floats:
    """Compute the share of signals (samples,) that were measured in each sample (samples, signals)."""
    return np.mean(~np.isnan(measured), axis=1)


def rms_of(errors: Floats, measured: Floats) -> Floats:
    """Compute the rms (signals,) of errors (samples, signals) of measured readings; 0 for a signal without any."""
    counts = np.count_nonzero(~np.isnan(measured), axis=0)
    return np.sqrt(np.sum(errors**2, axis=0) / np.maximum(counts, 1))


def extent(measured: Floats) -> Floats:
    """Compute the range (signals,) from the smallest to the largest reading; 0 for a signal without any."""
    return np.nan_to_num(np.fmax.reduce(measured, axis=0) - np.fmin.reduce(measured, axis=0))


def measured_time(time: Floats, measured: Floats) -> Floats:
    """Compute the time (samples,) [s] in which anything was measured, from the first sample to each."""
    idle = np.isnan(measured[:-1]).all(axis=1) * np.diff(time)
    return time - np.concatenate([[0.0], np.cumsum(idle)])
