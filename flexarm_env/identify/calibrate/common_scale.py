"""The common scale of torques, inertias and stiffness, and of the inverse of strain gages' gains.

No motion shows it. Only priors determine it, or a known payload. A fit does not find its way along such a direction: differences
are not exact enough to show that nothing changes.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.least_squares import cost_of
from flexarm_env.identify.calibrate.objective import Objective
from flexarm_env.identify.calibrate.parameters import FitParameters
from flexarm_env.identify.settings import LEAST_NORM

Floats = NDArray[np.float64]

_FORCE = re.compile(r"\b(N|Nm|kg)\b")


def force_power(unit: str) -> int:
    """Find the power with which a quantity of a unit scales with forces and masses: 1, -1, or 0."""
    found = _FORCE.search(unit)
    return 0 if found is None else -1 if "/" in unit[: found.start()] else 1


def force_powers(arm: Arm, parameters: FitParameters) -> NDArray[np.int64]:
    """Find that power of each parameter (x,); all 0 where the arm's torque constant is known."""
    powers = np.array([force_power(arm.parameter(p.path).unit) for p in parameters], dtype=np.int64)
    return powers if any(p.path == "drive.torque_constant" for p in parameters) else 0 * powers


def rescale(parameters: FitParameters, x: Floats, powers: NDArray[np.int64], shift: float) -> Floats:
    """Multiply all quantities that scale with forces by exp(shift)."""
    triples = zip(parameters, x, powers, strict=True)
    return np.array([p.x_of(p.value(float(v)) * np.exp(power * shift)) if power else v for p, v, power in triples])


def beside_scale(powers: NDArray[np.int64], prior: Floats) -> Floats:
    """Make the matrix (x, x) that takes the common scale out of a change of x, by the priors' weights."""
    onto_scale = powers / prior**2
    return np.eye(len(prior)) - np.outer(powers, onto_scale) / max(float(onto_scale @ powers), LEAST_NORM)


def best_scale(objective: Objective, x: Floats, powers: NDArray[np.int64]) -> tuple[Floats, float]:
    """Move x to the scale of least cost; also give the cost's curvature along the scale's logarithm.

    Args:
        objective: gives the priors and the residual.
        x: end of a fit (x,).
        powers: see `force_powers`.
    """

    def cost(shift: float) -> float:
        there = rescale(objective.parameters, x, powers, shift)
        return cost_of(objective.residual(there), there, objective.weights.prior)

    if not powers.any():
        return x, 0.0
    numbers = objective.dataset.settings.refining
    step, furthest = numbers.scale_step, numbers.scale_furthest
    below, here, above = (cost(shift) for shift in (-step, 0.0, step))
    curvature = (below + above - 2.0 * here) / (2.0 * step**2)
    if not curvature > 0.0:
        return x, 0.0
    shift = float(np.clip((below - above) / (4 * step * curvature), -furthest, furthest))
    best = rescale(objective.parameters, x, powers, shift) if cost(shift) < here else x
    return best, float(curvature)


def scale_deviation(objective: Objective, x: Floats, powers: NDArray[np.int64]) -> float:
    """Estimate the standard deviation of the scale's logarithm, from residual and priors.

    Priors are widened by the ratio at which the constants prove to be wrong (Birge, Phys. Rev. 40 (1932) 207). One more constant,
    off by one standard deviation of its prior, stands for the little evidence of so few.

    Args:
        objective: gives the priors and the residual.
        x: end of a fit (x,), on its best scale.
        powers: see `force_powers`.
    """
    if not powers.any():
        return 0.0
    prior = objective.weights.prior
    known = (powers != 0) & objective.parameters.constant
    wrong = (np.sum((x[known] / prior[known]) ** 2) + 1.0) / max(np.count_nonzero(known), 1)
    of_priors = np.sum((powers / prior) ** 2)
    of_residual = max(best_scale(objective, x, powers)[1] - of_priors, 0.0)
    return float((of_priors / wrong + of_residual) ** -0.5)
