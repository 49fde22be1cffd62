"""The last stretch of a fit, along what the data hardly show: exact differences, and steps as far as the priors let them go.

Levenberg–Marquardt damps each value by how much it changes the motion. Values that change it one by one, and hardly together, it
holds where they are. Replays that are nudged by the readings are smooth enough for exact differences, so the last stretch goes
through them to the free one.
"""

from __future__ import annotations

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
#: Error over noise above which a model lacks something, so that its nearest minimum is not the machine.
LACKS = 1.4


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

    Args:
        problem: in which x is judged, weighed by what the fit left, at the arm's own torque noise.
        x: where a fit ended (x,).
    """
    arm, coordinates = problem.arm, problem.coordinates
    powers = force_powers(arm, coordinates)
    scale, own = torque_scale(arm, problem.data.runs), problem.torque_noise
    x, _ = best_scale(problem, x, powers)
    if np.sqrt(np.mean((problem.sigma / problem.data.noise) ** 2)) > LACKS:
        return x
    other = x
    for noise in [level * scale for level in LEVELS if level * scale > own] + [own]:
        level = Problem(arm, problem.data, coordinates, noise, np.ones_like(problem.sigma))
        level.weigh(place_values(arm, coordinates, other), held=False)
        other, _ = best_scale(level, gauss_newton(level.residual, other, level.prior), powers)
    costs = [cost_of(problem.residual(there), there, problem.prior) for there in (other, x)]
    return other if costs[0] < costs[1] else x
