"""Levenberg–Marquardt on whitened residuals with a Gaussian prior, for replays that stick and slip.

A replay's error is rough in its constants: a hub that stops a moment later rests elsewhere. A derivative says nothing there; a
difference over a step as wide as the model is off does (statistical linearisation, as in ensemble Gauss–Newton: Chada, Chen and
Sanz-Alonso, Found. Data Sci. 3 (2021) 331), and steps shrink as the error falls. SciPy's least_squares takes derivatives over
steps of a fixed relative size, and cannot take columns over from an earlier fit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.settings import LEAST_NORM, LeastSquares

Floats = NDArray[np.float64]
#: The residual (rows,) at each of some points (x,).
Residuals = Callable[[Sequence[Floats]], Sequence[Floats]]


@dataclass(frozen=True)
class StepSizes:
    """Finite-difference steps of x.

    Attributes:
        least: narrowest (x,).
        most: widest (x,).
        now: in use (x,).
    """

    least: Floats
    most: Floats
    now: Floats

    def narrowed(self, factor: float) -> StepSizes:
        """Narrow the steps for good: near the end, curvature does more harm than roughness."""
        narrow = np.maximum(self.now / factor, self.least)
        return StepSizes(self.least, narrow, narrow)

    def finer(self, factor: float) -> StepSizes:
        """Narrow the steps further than to the narrowest, for a residual that is smooth."""
        narrow = self.now / factor
        return StepSizes(narrow, narrow, narrow)

    def adapted(self, residual: Floats, j: Floats, grow: bool) -> StepSizes:
        """Choose steps at which each x changes the residual by as much as is left of it; no wider ones unless they may grow."""
        sizes = np.linalg.norm(residual) / np.maximum(np.linalg.norm(j, axis=0), LEAST_NORM)
        sizes = np.clip(sizes, self.least, self.most)
        return StepSizes(self.least, self.most, sizes if grow else np.minimum(sizes, self.now))


@dataclass(frozen=True)
class Solution:
    """Where a minimisation ended.

    Attributes:
        x: (x,).
        cost: sum of squares of residual and prior.
        residual: (rows,).
        jacobian: (rows, x).
        steps: difference steps in use.
    """

    x: Floats
    cost: float
    residual: Floats
    jacobian: Floats
    steps: StepSizes


@dataclass(frozen=True)
class Goal:
    """What a minimisation has to reach to be of use.

    Attributes:
        measure: of a residual (rows,).
        most: its largest value that is of use.
    """

    measure: Callable[[Floats], float]
    most: float

    def is_out_of_reach(self, before: Floats, now: Floats, left: int) -> bool:
        """Whether as many Jacobians as are left end above it, if each lowers the measure as much as the last one did."""
        reached = self.measure(now)
        return reached - left * max(self.measure(before) - reached, 0.0) > self.most


@dataclass(frozen=True)
class Ending:
    """When a minimisation ends.

    Attributes:
        iterations: most Jacobians.
        tolerance: relative decrease of the cost at which to stop, unless narrower differences may help.
        goal: out of reach of which it stops; none if left out.
    """

    iterations: int
    tolerance: float
    goal: Goal | None = None


def one_by_one(residual: Callable[[Floats], Floats]) -> Residuals:
    """Make residuals at some points of a residual (rows,) at one (x,)."""
    return lambda points: [residual(x) for x in points]


def jacobian(residuals: Residuals, x: Floats, steps: Floats, first: int = 0) -> Floats:
    """Compute central differences (rows, steps) of the residual over steps to either side, of x from the first on."""
    if not len(steps):
        return np.zeros((len(residuals([x])[0]), 0))
    found = residuals([_aside(x, first + k, side * width) for k, width in enumerate(steps) for side in (1.0, -1.0)])
    pairs = zip(found[::2], found[1::2], steps, strict=True)
    return _of_columns([(there - back) / (2.0 * width) for there, back, width in pairs])


def slopes(residuals: Residuals, x: Floats, here: Floats, steps: Floats) -> Floats:
    """Compute differences (rows, x) of the residual over steps to one side.

    Half the replays of central ones, where steps are so narrow that the residual is straight over them. Steps up are taken, or
    steps down where a value has no room above.

    Args:
        residuals: whitened residuals (rows,) at some points.
        x: where (x,).
        here: the residual there (rows,).
        steps: widths (x,).
    """
    if not len(steps):
        return np.zeros((len(here), 0))
    found = residuals([_aside(x, k, width) for k, width in enumerate(steps)])
    columns = [(above - here) / width for above, width in zip(found, steps, strict=True)]
    still = [k for k, column in enumerate(columns) if not column.any()]
    for k, below in zip(still, residuals([_aside(x, k, -steps[k]) for k in still]) if still else (), strict=True):
        columns[k] = (here - below) / steps[k]
    return _of_columns(columns)


def _aside(x: Floats, k: int, width: float) -> Floats:
    there = x.copy()
    there[k] += width
    return there


def _of_columns(columns: Sequence[Floats]) -> Floats:
    return np.nan_to_num(np.stack(columns, axis=1))


def cost_of(residual: Floats, x: Floats, prior: Floats) -> float:
    """Sum the squares of residual and prior; infinite where a replay failed."""
    total = float(residual @ residual + np.sum((x / prior) ** 2))
    return total if np.isfinite(total) else np.inf


def minimise(
    residuals: Residuals,
    x: Floats,
    prior: Floats,
    steps: StepSizes,
    numbers: LeastSquares,
    ending: Ending,
    frozen: Floats | None = None,
) -> Solution:
    """Minimise |residual(x)|² + |x / prior|².

    The first Jacobian says nothing of the next ones: its differences may be far too wide.

    Args:
        residuals: whitened residuals (rows,) at some points.
        x: where to start.
        prior: standard deviation of each x around 0.
        steps: of the differences; of the last of x, where there are frozen columns.
        numbers: dampings and step rules.
        ending: of the minimisation.
        frozen: Jacobian (rows, first columns) taken over from elsewhere and not computed again.
    """
    r = residuals([x])[0]
    point = _Point(x, r, cost_of(r, x, prior), numbers.first_damping)
    known = 0 if frozen is None else frozen.shape[1]
    j = np.empty((len(r), len(x)))
    if frozen is not None:
        j[:, :known] = frozen
    goal = ending.goal
    for left in reversed(range(ending.iterations)):
        if known < len(x):
            j[:, known:] = jacobian(residuals, point.x, steps.now, known)
        before = point
        point = _descend(residuals, point, j, prior, numbers)
        stays = before.cost - point.cost < ending.tolerance * before.cost
        finer = steps.adapted(point.residual, j[:, known:], grow=not stays)
        if stays and np.all(finer.now > numbers.shrinks * steps.now):
            break
        is_first = left == ending.iterations - 1
        if goal and not is_first and goal.is_out_of_reach(before.residual, point.residual, left):
            break
        steps = finer
    return Solution(point.x, point.cost, point.residual, j, steps)


@dataclass(frozen=True)
class _Point:
    """Where a minimisation stands: x, residual (rows,), cost, and the damping of the next step."""

    x: Floats
    residual: Floats
    cost: float
    damping: float


def descend(residuals: Residuals, x: Floats, slopes: Floats, prior: Floats, numbers: LeastSquares) -> tuple[Floats, Floats]:
    """Lower |residual(x)|² + |x / prior|² by damped steps along one Jacobian, which each corrects for the next.

    Args:
        residuals: whitened residuals (rows,) at some points.
        x: where to start (x,).
        slopes: Jacobian there (rows, x).
        prior: standard deviation of each x around 0.
        numbers: dampings and step rules.

    Returns:
        Where the steps ended (x,), and the Jacobian that they corrected (rows, x).
    """
    r, j = residuals([x])[0], slopes.copy()
    point = _Point(x, r, cost_of(r, x, prior), numbers.first_damping)
    return _descend(residuals, point, j, prior, numbers).x, j


def _descend(residuals: Residuals, point: _Point, j: Floats, prior: Floats, numbers: LeastSquares) -> _Point:
    """Take damped steps along one Jacobian, which each corrects in place for the next, while they lower the cost enough."""
    x, r, cost, damping = point.x, point.residual, point.cost, point.damping
    for number in range(numbers.steps):
        normal = j.T @ j + np.diag(prior**-2.0)
        slope = j.T @ r + x / prior**2
        last = cost
        for _ in range(1 if number else numbers.trials):
            step = -np.linalg.solve(normal + damping * np.diag(np.diag(normal)), slope)
            step = np.clip(step, -numbers.largest_step, numbers.largest_step)
            trial = residuals([x + step])[0]
            new = cost_of(trial, x + step, prior)
            if new < cost:
                j += secant_correction(trial - r - j @ step, step, np.diag(normal))
                x, r, cost = x + step, trial, new
                damping = max(damping * numbers.less_damping, numbers.least_damping)
                break
            damping = max(numbers.more_damping * damping, numbers.least_helpful)
        if last - cost < numbers.worthwhile * last:
            break
    return _Point(x, r, cost, damping)


def secant_correction(missed: Floats, step: Floats, weights: Floats) -> Floats:
    """Compute the correction by which a Jacobian reproduces the change along a step, in weighted x.

    Broyden, Math. Comput. 19 (1965) 577.
    """
    along = weights * step
    return np.outer(missed, along / (along @ step))


def covariance(j: Floats, residual: Floats, prior: Floats, block: int) -> Floats:
    """Estimate the covariance (x, x) of a fit with a residual that need not be white.

    Sandwich of the normal equations around the scatter of the gradient summed over blocks of `block` rows (Newey and West,
    Econometrica 55 (1987) 703, with blocks for lags). All is taken along the singular directions of the Jacobian in priors: as a
    matrix, the normal equations are singular to rounding where data fix one value 1e8 times as well as another.
    """
    scaled = j * prior
    _, strengths, axes = np.linalg.svd(np.vstack([scaled, np.eye(len(prior))]), full_matrices=False)
    block = min(block, len(residual))
    count = len(residual) // block
    rows = residual[: count * block, None] * (scaled[: count * block] @ axes.T)
    sums = rows.reshape(count, block, -1).sum(axis=1)
    root = prior[:, None] * axes.T / strengths**2
    spread: Floats = root @ (sums.T @ sums + np.eye(len(prior))) @ root.T
    return spread
