"""Means with intervals, and paired differences: bootstrap over arms (Efron, Tibshirani, 1993)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RESAMPLES = 2000
LEVEL = 0.95


def mean_interval(values: Floats, seed: int = 0) -> tuple[float, float, float]:
    """Return the mean of values (arms,) and the ends of its 95 % bootstrap interval."""
    draws = np.random.default_rng(seed).integers(0, len(values), (RESAMPLES, len(values)))
    means = values[draws].mean(axis=1)
    low, high = np.quantile(means, [0.5 - LEVEL / 2, 0.5 + LEVEL / 2])
    return float(values.mean()), float(low), float(high)


def paired_difference(values: Floats, reference: Floats, seed: int = 0) -> tuple[float, float, float]:
    """Return the mean of values − reference, arm by arm (arms,), and the ends of its 95 % bootstrap interval."""
    return mean_interval(values - reference, seed)
