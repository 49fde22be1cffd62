"""Means, interquartile means and paired comparisons with bootstrap intervals (Efron, Tibshirani, 1993).

Over training runs as Agarwal et al. advise (Deep Reinforcement Learning at the Edge of the Statistical Precipice, NeurIPS
2021): the interquartile mean, and runs drawn again, since another seed gives another policy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
#: Value, low and high end of its 95 % interval.
Interval = tuple[float, float, float]

RESAMPLES = 2000
LEVEL = 0.95
#: Number of resamples drawn at once, for speed within little memory.
AT_ONCE = 200
BATCHES = range(RESAMPLES // AT_ONCE)


def mean_interval(values: Floats, seed: int = 0) -> Interval:
    """Compute the mean of values (arms,) and the ends of its 95 % bootstrap interval."""
    draws = np.random.default_rng(seed).integers(0, len(values), (RESAMPLES, len(values)))
    return with_ends(float(values.mean()), values[draws].mean(axis=1))


def paired_difference(values: Floats, reference: Floats, seed: int = 0) -> Interval:
    """Compute the mean of values − reference, arm by arm (arms,), and the ends of its 95 % bootstrap interval."""
    return mean_interval(values - reference, seed)


def interquartile_mean(values: Floats) -> Floats:
    """Compute the mean of the middle half of values (…, values): a quarter is left out at each end."""
    ordered = np.sort(values, axis=-1)
    cut = ordered.shape[-1] // 4
    found: Floats = ordered[..., cut : ordered.shape[-1] - cut].mean(axis=-1)
    return found


def stratified_interval(
    strata: Sequence[Floats], statistic: Callable[[Floats], Floats] = interquartile_mean, seed: int = 0
) -> Interval:
    """Compute a statistic of all values and the ends of its 95 % interval, with runs and arms resampled within each stratum.

    A run is drawn whole, with all its arms, and so is an arm, with all its runs: what one policy does on two arms, or two
    policies on one arm, is not independent. A controller is one run, which leaves the arms.

    Args:
        strata: values (runs, arms) of each stratum, such as a task or set; how many there are may differ.
        statistic: of values (…, values), along the last axis.
        seed: of the draws.
    """
    draw = np.random.default_rng(seed)
    found = [statistic(np.concatenate([drawn_again(values, draw, AT_ONCE) for values in strata], axis=1)) for _ in BATCHES]
    return with_ends(float(statistic(np.concatenate([values.ravel() for values in strata]))), np.concatenate(found))


def improvement(values: Floats, reference: Floats, seed: int = 0) -> Interval:
    """Estimate the probability that a run is better (less) than a reference on the same arm; ties count half.

    Args:
        values: (runs, arms).
        reference: (runs, arms), of other runs on the same arms; a controller is one run.
        seed: of the draws, in which both sides draw the same arms.
    """
    better = np.array([(values < other) + 0.5 * (values == other) for other in reference])
    draw = np.random.default_rng(seed)
    others, runs, arms = (draw.integers(0, size, (RESAMPLES, size)) for size in better.shape)
    found = [better[np.ix_(*chosen)].mean() for chosen in zip(others, runs, arms, strict=True)]
    return with_ends(float(better.mean()), np.array(found))


def drawn_again(values: Floats, draw: np.random.Generator, times: int) -> Floats:
    """Resample runs and arms of values (runs, arms): (times, runs · arms)."""
    runs, arms = (draw.integers(0, size, (times, size)) for size in values.shape)
    return values[runs[:, :, None], arms[:, None, :]].reshape(times, -1)


def with_ends(value: float, found: Floats) -> Interval:
    """Compute the ends of a value's 95 % interval from its resamples (resamples,)."""
    low, high = np.quantile(found, [0.5 - LEVEL / 2, 0.5 + LEVEL / 2])
    return value, float(low), float(high)
