"""Levenberg–Marquardt on whitened residuals with a Gaussian prior, for replays that stick and slip.

A replay's error is rough in its constants: a hub that stops a moment later rests elsewhere. A derivative says nothing there; a
difference over a step as wide as the model is off does (statistical linearisation, as in ensemble Gauss–Newton: Chada, Chen and
Sanz-Alonso, Found. Data Sci. 3 (2021) 331), and steps shrink as the error falls. SciPy's least_squares takes derivatives over
steps of a fixed relative size, and cannot take columns over from an earlier fit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from joblib import Parallel, delayed, parallel_config
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Residual = Callable[[Floats], Floats]

LARGEST_STEP = 3.0
#: Steps along one Jacobian, which each corrects for the next, while they lower the cost by this share; and trials of the first.
STEPS, WORTHWHILE, TRIALS = 4, 0.01, 5
#: Damping below which a step is that of Gauss and Newton.
LEAST_HELPFUL = 1e-3
#: Differences that shrank by less than this factor would give the same Jacobian once more.
SHRINKS = 0.7
#: By how much differences are narrower in the end.
NARROW = 8.0


@dataclass(frozen=True)
class Reach:
    """How far x is moved for differences (x,): at least, at most, and now."""

    least: Floats
    most: Floats
    now: Floats

    def narrowed(self) -> Reach:
        """Return a reach that stays narrow: where a fit has come near, curvature does more harm than roughness."""
        narrow = np.maximum(self.now / NARROW, self.least)
        return Reach(self.least, narrow, narrow)

    def adapted(self, residual: Floats, j: Floats, grow: bool) -> Reach:
        """Return the reach at which each x changes the residual by as much as is left of it; no larger unless it may grow."""
        sizes = np.linalg.norm(residual) / np.maximum(np.linalg.norm(j, axis=0), 1e-300)
        sizes = np.clip(sizes, self.least, self.most)
        return Reach(self.least, self.most, sizes if grow else np.minimum(sizes, self.now))


@dataclass
class Solution:
    """Where a fit ended: x, its cost (residual and prior), the residual, its Jacobian there (rows, x), and its reach."""

    x: Floats
    cost: float
    residual: Floats
    jacobian: Floats
    reach: Reach


def in_threads(jobs: int) -> parallel_config:
    """Return a context in which columns of Jacobians are made in so many threads: replays leave the interpreter free."""
    return parallel_config(backend="threading", n_jobs=jobs)


def jacobian(residual: Residual, x: Floats, steps: Floats, first: int = 0) -> Floats:
    """Return central differences (rows, steps) of the residual over steps to either side, of x from the first on.

    Columns are made in one thread unless called in_threads.
    """

    def column(k: int, width: float) -> Floats:
        above, below = x.copy(), x.copy()
        above[k] += width
        below[k] -= width
        return (residual(above) - residual(below)) / (2.0 * width)

    if not len(steps):
        return np.zeros((len(residual(x)), 0))
    columns = Parallel(prefer="threads")(delayed(column)(k, width) for k, width in enumerate(steps, start=first))
    return np.nan_to_num(np.stack(columns, axis=1))


def cost_of(residual: Floats, x: Floats, prior: Floats) -> float:
    """Return the sum of squares of residual and prior; infinite where a replay failed."""
    total = float(residual @ residual + np.sum((x / prior) ** 2))
    return total if np.isfinite(total) else np.inf


def minimise(
    residual: Residual,
    x: Floats,
    prior: Floats,
    reach: Reach,
    iterations: int,
    frozen: Floats | None = None,
    tolerance: float = 1e-3,
) -> Solution:
    """Minimise |residual(x)|² + |x / prior|².

    Args:
        residual: whitened residual (rows,).
        x: where to start.
        prior: standard deviation of each x around 0.
        reach: of the differences; the last of x, where there are frozen columns.
        iterations: at most so many Jacobians.
        frozen: Jacobian (rows, first columns) taken over from elsewhere and not computed again.
        tolerance: relative decrease of the cost at which to stop, unless smaller differences may help.
    """
    r = residual(x)
    cost = cost_of(r, x, prior)
    damping = 1e-3
    known = 0 if frozen is None else frozen.shape[1]
    j = np.empty((len(r), len(x)))
    if frozen is not None:
        j[:, :known] = frozen
    for _ in range(iterations):
        if known < len(x):
            j[:, known:] = jacobian(residual, x, reach.now, known)
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
        stays = before - cost < tolerance * before
        finer = reach.adapted(r, j[:, known:], grow=not stays)
        if stays and np.all(finer.now > SHRINKS * reach.now):
            break
        reach = finer
    return Solution(x, cost, r, j, reach)


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
    block = min(block, len(residual))
    count = len(residual) // block
    rows = residual[: count * block, None] * j[: count * block]
    sums = rows.reshape(count, block, -1).sum(axis=1)
    meat = sums.T @ sums + np.diag(prior**-2.0)
    spread: Floats = bread @ meat @ bread
    return spread
