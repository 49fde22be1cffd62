"""The last stretch of a fit, along what the data hardly show: exact differences, and steps as far as the priors let them go.

Levenberg–Marquardt damps each value by how much it changes the motion. Values that change it one by one, and hardly together, it
holds where they are. Replays that are nudged by the readings are smooth enough for exact differences, so the last stretch goes
through them to the free one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.common_scale import best_scale, force_powers
from flexarm_env.identify.coordinates import place_values
from flexarm_env.identify.least_squares import Residual, cost_of, jacobian
from flexarm_env.identify.problem import Problem
from flexarm_env.identify.scales import torque_scale

Floats = NDArray[np.float64]

#: Process noise of the levels, over the rms of the drive's torque, before the arm's own.
LEVELS = (3e-3, 3e-4, 3e-5)
#: Differences of x, iterations at each level, and the relative decrease of the cost at which a level is left.
DIFFERENCE, ITERATIONS, TOLERANCE = 1e-5, 5, 1e-4
#: Dampings that are tried in turn, over the priors' weight.
DAMPINGS = (0.0, 1e1, 1e2, 1e3, 1e4)
#: Error over noise above which a model lacks something, so that its nearest minimum is not the machine; below which it is there.
LACKS, AT_NOISE = 1.4, 1.002
#: How far to either side other minima are sought, in priors' standard deviations, and through which levels.
ASIDE, LEVELS_ASIDE = 0.3, (3e-3, 3e-5)


def gauss_newton(residual: Residual, x: Floats, prior: Floats) -> Floats:
    """Return where |residual(x)|² + |x / prior|² ends that falls from x.

    Args:
        residual: whitened residual (rows,).
        x: where to start (x,).
        prior: standard deviation of each x around 0.
    """
    r = residual(x)
    cost = cost_of(r, x, prior)
    for _ in range(ITERATIONS):
        j = jacobian(residual, x, np.full(len(x), DIFFERENCE)) * prior
        strengths, axes = np.linalg.eigh(j.T @ j)
        slope, before = axes.T @ (j.T @ r + x / prior), cost
        for damping in DAMPINGS:
            trial = x - prior * (axes @ (slope / (strengths + 1.0 + damping)))
            left = residual(trial)
            new = cost_of(left, trial, prior)
            if new < cost:
                x, r, cost = trial, left, new
                break
        if before - cost < TOLERANCE * before:
            break
    return x


def settled(problem: Problem, x: Floats) -> Floats:
    """Return x on the best common scale and as far as it goes; on that scale only, if the rest does not help or lacks something.

    A replay is rough along what the data hardly show, and a fit ends in one of its hollows. Where more is left than noise, two
    more are sought from some way to either side.

    Args:
        problem: in which x is judged, weighed by what the fit left, at the arm's own torque noise.
        x: where a fit ended (x,).
    """
    x, _ = best_scale(problem, x, force_powers(problem.arm, problem.coordinates))
    if not len(x) or np.sqrt(np.mean((problem.sigma / problem.data.noise) ** 2)) > LACKS:
        return x

    def cost(there: Floats) -> float:
        return cost_of(problem.residual(there), there, problem.prior)

    best = min(x, _descended(problem, x, LEVELS), key=cost)
    if _error(problem, best) > AT_NOISE:
        aside = ASIDE * problem.prior * _loosest(problem, best)
        starts = best - aside, best + aside
        best = min(best, *(_descended(problem, start, LEVELS_ASIDE) for start in starts), key=cost)
    return best


def _descended(problem: Problem, x: Floats, levels: Sequence[float]) -> Floats:
    """Return where x gets through levels of process noise, over the rms of the drive's torque, and then at the arm's own."""
    powers = force_powers(problem.arm, problem.coordinates)
    scale, own = torque_scale(problem.arm, problem.data.runs), problem.torque_noise
    for noise in [level * scale for level in levels if level * scale > own] + [own]:
        level = _at_level(problem, x, noise)
        x, _ = best_scale(level, gauss_newton(level.residual, x, level.prior), powers)
    return x


def _at_level(problem: Problem, x: Floats, torque_noise: float) -> Problem:
    level = Problem(problem.arm, problem.data, problem.coordinates, torque_noise, np.ones_like(problem.sigma))
    level.weigh(place_values(problem.arm, problem.coordinates, x), held=False)
    return level


def _error(problem: Problem, x: Floats) -> float:
    """Return the rms error of a whole replay over the noise."""
    errors = problem.errors_of(place_values(problem.arm, problem.coordinates, x))
    return float(np.sqrt(np.mean((np.concatenate(errors) / problem.data.noise) ** 2)))


def _loosest(problem: Problem, x: Floats) -> Floats:
    """Return the direction of unit length, in priors' standard deviations, that the data hold least but for the common scale."""
    level = _at_level(problem, x, max(LEVELS[0] * torque_scale(problem.arm, problem.data.runs), problem.torque_noise))
    j = jacobian(level.residual, x, np.full(len(x), DIFFERENCE)) * level.prior
    onto_scale = force_powers(problem.arm, problem.coordinates) / level.prior
    length = np.linalg.norm(onto_scale)
    j -= np.outer(j @ onto_scale, onto_scale) / max(length**2, 1e-300)
    _, axes = np.linalg.eigh(j.T @ j)
    return axes[:, 1 if length and len(x) > 1 else 0]  # the scale itself comes first
