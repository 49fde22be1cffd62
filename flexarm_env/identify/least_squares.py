"""Levenberg–Marquardt on whitened residuals with a Gaussian prior, for models whose Jacobian is dear.

SciPy's least_squares factors the whole Jacobian at each trial; here it is 60,000 rows by 15 columns of replays, so its normal
equations are formed once per iteration, and columns that hardly change are taken over from an earlier fit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Residual = Callable[[Floats], Floats]

LARGEST_STEP = 3.0
#: Steps along one Jacobian, which each corrects for the next, while they lower the cost by this share; and trials of the first.
STEPS, WORTHWHILE, TRIALS = 4, 0.01, 5
#: Damping below which a step is that of Gauss and Newton.
LEAST_HELPFUL = 1e-3


@dataclass
class Solution:
    """Where a fit ended: x, its cost (residual and prior), the residual, its Jacobian there (rows, x)."""

    x: Floats
    cost: float
    residual: Floats
    jacobian: Floats


def jacobian(residual: Residual, x: Floats, at_x: Floats, steps: Floats, columns: range | None = None) -> Floats:
    """Return forward differences (rows, columns) of the residual over steps (x,)."""
    chosen = range(len(x)) if columns is None else columns
    out = np.empty((len(at_x), len(chosen)))
    for i, k in enumerate(chosen):
        moved = x.copy()
        moved[k] += steps[k]
        out[:, i] = (residual(moved) - at_x) / steps[k]
    return np.nan_to_num(out)


def cost_of(residual: Floats, x: Floats, prior: Floats) -> float:
    """Return the sum of squares of residual and prior; infinite where a replay failed."""
    total = float(residual @ residual + np.sum((x / prior) ** 2))
    return total if np.isfinite(total) else np.inf


def minimise(
    residual: Residual,
    x: Floats,
    prior: Floats,
    steps: Floats,
    iterations: int,
    frozen: Floats | None = None,
    tolerance: float = 1e-4,
) -> Solution:
    """Minimise |residual(x)|² + |x / prior|².

    Args:
        residual: whitened residual (rows,).
        x: where to start.
        prior: standard deviation of each x around 0.
        steps: for the differences, of each x.
        iterations: at most so many Jacobians.
        frozen: Jacobian (rows, first columns) taken over from elsewhere and not computed again.
        tolerance: relative decrease of the cost at which to stop.
    """
    r = residual(x)
    cost = cost_of(r, x, prior)
    damping = 1e-3
    known = 0 if frozen is None else frozen.shape[1]
    j = np.empty((len(r), len(x)))
    if frozen is not None:
        j[:, :known] = frozen
    for _ in range(iterations):
        j[:, known:] = jacobian(residual, x, r, steps, range(known, len(x)))
        before = cost
        for number in range(STEPS):
            normal = j.T @ j + np.diag(prior**-2.0)
            slope = j.T @ r + x / prior**2
            last = cost
            for _ in range(1 if number else TRIALS):
                step = -np.linalg.solve(normal + damping * np.diag(np.diag(normal)), slope)
                step = np.clip(step, -LARGEST_STEP, LARGEST_STEP)
                trial = residual(x + step)
                new = cost_of(trial, x + step, prior)
                if new < cost:
                    j += _secant_correction(trial - r - j @ step, step, np.diag(normal))
                    x, r, cost = x + step, trial, new
                    damping = max(damping * 0.2, 1e-7)
                    break
                damping = max(10.0 * damping, LEAST_HELPFUL)
            if last - cost < WORTHWHILE * last:
                break
        if before - cost < tolerance * before:
            break
    return Solution(x, cost, r, j)


def _secant_correction(missed: Floats, step: Floats, weights: Floats) -> Floats:
    """Return what a Jacobian lacks to give what a step changed (Broyden, Math. Comput. 19 (1965) 577), in weighted x."""
    along = weights * step
    return np.outer(missed, along / (along @ step))


def covariance(j: Floats, residual: Floats, prior: Floats, block: int) -> Floats:
    """Return the covariance (x, x) of a fit, which holds when the residual is not white.

    Sandwich of the normal equations around the scatter of the gradient summed over blocks of `block` rows (Newey and West,
    Econometrica 55 (1987) 703, with blocks for lags).
    """
    bread = np.linalg.inv(j.T @ j + np.diag(prior**-2.0))
    count = max(len(residual) // block, 1)
    rows = residual[: count * block, None] * j[: count * block]
    sums = rows.reshape(count, block, -1).sum(axis=1)
    meat = sums.T @ sums + np.diag(prior**-2.0)
    spread: Floats = bread @ meat @ bread
    return np.maximum(spread, 0.0) if spread.ndim == 1 else spread
