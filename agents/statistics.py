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


def mean_interval(values: Floats, seed: int = 0) -> Interval:
    """Return the mean of values (arms,) and the ends of its 95 % bootstrap interval."""
    draws = np.random.default_rng(seed).integers(0, len(values), (RESAMPLES, len(values)))
    return with_ends(float(values.mean()), values[draws].mean(axis=1))


def paired_difference(values: Floats, reference: Floats, seed: int = 0) -> Interval:
    """Return the mean of values − reference, arm by arm (arms,), and the ends of its 95 % bootstrap interval."""
    return mean_interval(values - reference, seed)


def interquartile_mean(values: Floats) -> float:
    """Return the mean of the middle half of values (any shape): a quarter is left out at each end."""
    ordered = np.sort(values, axis=None)
    cut = len(ordered) // 4
    return float(ordered[cut : len(ordered) - cut].mean())


def stratified_interval(
    strata: Sequence[Floats], statistic: Callable[[Floats], float] = interquartile_mean, seed: int = 0
) -> Interval:
    """Return a statistic of all values and the ends of its 95 % interval, runs and arms drawn again within each stratum.

    A run is drawn whole, with all its arms, and so is an arm, with all its runs: what one policy does on two arms, or two
    policies on one arm, is not independent. A controller is one run, which leaves the arms.

    Args:
        strata: values (runs, arms) of each stratum, such as a task or set; how many there are may differ.
        statistic: of values of any shape.
        seed: of the draws.
    """
    draw = np.random.default_rng(seed)
    found = [statistic(_joined([drawn_again(values, draw) for values in strata])) for _ in range(RESAMPLES)]
    return with_ends(statistic(_joined(strata)), np.array(found))


def improvement(values: Floats, reference: Floats, seed: int = 0) -> Interval:
    """Return how probable it is that a run does better (less) than a reference on the same arm; ties count half.

    Args:
        values: (runs, arms).
        reference: (runs, arms), of other runs on the same arms; a controller is one run.
        seed: of the draws, in which both sides draw the same arms.
    """
    better = np.array([_better(values, other) for other in reference])
    draw = np.random.default_rng(seed)
    found = []
    for _ in range(RESAMPLES):
        arms = draw.integers(0, better.shape[2], better.shape[2])
        others, runs = (draw.integers(0, size, size) for size in better.shape[:2])
        found.append(better[np.ix_(others, runs, arms)].mean())
    return with_ends(float(better.mean()), np.array(found))


def _better(values: Floats, other: Floats) -> Floats:
    """Return 1 where values (runs, arms) are less than other (arms,), ½ where they are the same, else 0."""
    found: Floats = (values < other) + 0.5 * (values == other)
    return found


def drawn_again(values: Floats, draw: np.random.Generator) -> Floats:
    """Return values (runs, arms) with runs, and arms, drawn again."""
    runs, arms = (draw.integers(0, size, size) for size in values.shape)
    return values[np.ix_(runs, arms)]


def _joined(strata: Sequence[Floats]) -> Floats:
    return np.concatenate([values.ravel() for values in strata])


def with_ends(value: float, found: Floats) -> Interval:
    """Return a value with the ends of its 95 % interval, from what resampling found (resamples,)."""
    low, high = np.quantile(found, [0.5 - LEVEL / 2, 0.5 + LEVEL / 2])
    return value, float(low), float(high)
