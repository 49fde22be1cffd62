"""Final Gauss–Newton steps along weakly observable directions.

Levenberg–Marquardt damps each value by how much it changes the motion. Values that change it one by one, and hardly together,
stay where they are. Observer-corrected replays are smooth enough for narrow differences, so the final steps go through them to
the free replay.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.calibrate.common_scale import best_scale, force_powers
from flexarm_env.identify.calibrate.least_squares import Residual, cost_of, jacobian
from flexarm_env.identify.calibrate.objective import Objective, objective_at
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.settings import LEAST_NORM, Refining

Floats = NDArray[np.float64]


def gauss_newton(residual: Residual, x: Floats, prior: Floats, numbers: Refining) -> Floats:
    """Minimise |residual(x)|² + |x / prior|² by damped Gauss–Newton steps.

    Args:
        residual: whitened residual (rows,).
        x: where to start (x,).
        prior: standard deviation of each x around 0.
        numbers: differences, dampings and stopping rule.
    """
    r = residual(x)
    cost = cost_of(r, x, prior)
    for _ in range(numbers.iterations):
        j = jacobian(residual, x, np.full(len(x), numbers.difference)) * prior
        strengths, axes = np.linalg.eigh(j.T @ j)
        slope, before = axes.T @ (j.T @ r + x / prior), cost
        for damping in numbers.dampings:
            trial = x - prior * (axes @ (slope / (strengths + 1.0 + damping)))
            left = residual(trial)
            new = cost_of(left, trial, prior)
            if new < cost:
                x, r, cost = trial, left, new
                break
        if before - cost < numbers.tolerance * before:
            break
    return x


def refine(objective: Objective, x: Floats) -> Floats:
    """Move x to the best common scale and, where the model lacks nothing, on along weakly observable directions.

    A replay is rough along those directions, and a fit ends in a local minimum. Where more is left than noise, two more minima
    are sought from some way to either side.

    Args:
        objective: weighted by the errors where the fit ended, at the arm's own torque noise.
        x: where the fit ended (x,).
    """
    dataset = objective.dataset
    errors, process_noise = dataset.settings.errors, dataset.settings.process_noise
    x, _ = best_scale(objective, x, force_powers(objective.arm, objective.parameters))
    if not len(x) or np.sqrt(np.mean((objective.weights.sigma / dataset.noise) ** 2)) > errors.close:
        return x

    def cost(there: Floats) -> float:
        return cost_of(objective.residual(there), there, objective.weights.prior)

    best: Floats = min(x, _descend(objective, x, process_noise.refinement), key=cost)
    if _error(objective, best) > errors.converged:
        aside = dataset.settings.refining.aside * objective.weights.prior * _weakest_direction(objective, best)
        starts = best - aside, best + aside
        best = min(best, *(_descend(objective, start, process_noise.refinement_aside) for start in starts), key=cost)
    return best


def _descend(objective: Objective, x: Floats, levels: Sequence[float]) -> Floats:
    """Minimise through levels of process noise, over the rms torque of the drive, and then at the arm's own."""
    powers = force_powers(objective.arm, objective.parameters)
    scale, own = torque_scale(objective.arm, objective.dataset.runs), objective.torque_noise
    numbers = objective.dataset.settings.refining
    for noise in [level * scale for level in levels if level * scale > own] + [own]:
        level = _at_level(objective, x, noise)
        x, _ = best_scale(level, gauss_newton(level.residual, x, level.weights.prior, numbers), powers)
    return x


def _at_level(objective: Objective, x: Floats, torque_noise: float) -> Objective:
    level = objective_at(objective.arm, objective.dataset, objective.parameters, torque_noise)
    return level.weighted_by(objective.parameters.apply(objective.arm, x), narrow_priors=False)


def _error(objective: Objective, x: Floats) -> float:
    """Compute the rms error of a whole replay over the noise."""
    dataset = objective.dataset
    errors = np.concatenate(objective.errors_of(objective.parameters.apply(objective.arm, x)))
    return float(np.sqrt(np.sum((errors / dataset.noise) ** 2) / dataset.readings(held_out=False)))


def _weakest_direction(objective: Objective, x: Floats) -> Floats:
    """Find the least observable direction but for the common scale: of unit length, in priors' standard deviations."""
    settings = objective.dataset.settings
    first = settings.process_noise.refinement[0] * torque_scale(objective.arm, objective.dataset.runs)
    level = _at_level(objective, x, max(first, objective.torque_noise))
    j = jacobian(level.residual, x, np.full(len(x), settings.refining.difference)) * level.weights.prior
    onto_scale = force_powers(objective.arm, objective.parameters) / level.weights.prior
    length = float(np.linalg.norm(onto_scale))
    j -= np.outer(j @ onto_scale, onto_scale) / max(length**2, LEAST_NORM)
    _, axes = np.linalg.eigh(j.T @ j)
    return axes[:, 1 if length and len(x) > 1 else 0]  # the scale itself comes first
