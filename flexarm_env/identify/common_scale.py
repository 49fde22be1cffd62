"""The scale that torques, inertias and stiffness have in common, and strain gages the inverse of.

No motion shows it, so that only priors say what it is, or a known payload. A fit does not find its way along such a direction:
differences are not exact enough to tell that nothing changes.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.coordinates import Coordinate
from flexarm_env.identify.least_squares import cost_of
from flexarm_env.identify.problem import Problem

Floats = NDArray[np.float64]

#: Steps [log] by which the scale is tried at first, and the furthest that it goes at once.
STEP, FURTHEST = 0.02, 0.5
_FORCE = re.compile(r"\b(N|Nm|kg)\b")


def force_power(unit: str) -> int:
    """Return how a quantity of a unit goes with forces and masses: 1, -1, or 0."""
    found = _FORCE.search(unit)
    return 0 if found is None else -1 if "/" in unit[: found.start()] else 1


def force_powers(arm: Arm, coordinates: Sequence[Coordinate]) -> NDArray[np.int64]:
    """Return that of each coordinate (x,); of none, where the arm's torque constant is known."""
    powers = np.array([force_power(arm.parameter(c.path).unit) for c in coordinates], dtype=np.int64)
    return powers if any(c.path == "drive.torque_constant" for c in coordinates) else 0 * powers


def rescaled(coordinates: Sequence[Coordinate], x: Floats, powers: NDArray[np.int64], shift: float) -> Floats:
    """Return x where all that goes with forces is exp(shift) as large."""
    pairs = zip(coordinates, x, powers, strict=True)
    return np.array([c.x_of(c.value(float(v)) * np.exp(p * shift)) if p else v for c, v, p in pairs])


def best_scale(problem: Problem, x: Floats, powers: NDArray[np.int64]) -> tuple[Floats, float]:
    """Return x on the scale where residual and priors are least, and the cost's curvature along the scale's logarithm.

    Args:
        problem: whose priors and residual count.
        x: where a fit ended (x,).
        powers: see `force_powers`.
    """

    def cost(shift: float) -> float:
        there = rescaled(problem.coordinates, x, powers, shift)
        return cost_of(problem.residual(there), there, problem.prior)

    if not powers.any():
        return x, 0.0
    below, here, above = (cost(shift) for shift in (-STEP, 0.0, STEP))
    curvature = (below + above - 2.0 * here) / (2.0 * STEP**2)
    if not curvature > 0.0:
        return x, 0.0
    shift = float(np.clip((below - above) / (4.0 * STEP * curvature), -FURTHEST, FURTHEST))
    best = rescaled(problem.coordinates, x, powers, shift) if cost(shift) < here else x
    return best, float(curvature)


def scale_deviation(problem: Problem, x: Floats, powers: NDArray[np.int64]) -> float:
    """Return the standard deviation of the scale's logarithm, from residual and priors.

    The priors count as wide as the constants prove to be wrong (Birge, Phys. Rev. 40 (1932) 207): those of an arm whose ratios
    were all right say more of their scale than those of one whose ratios were wrong by a third. One more constant, as far off as
    its prior is wide, stands for what so few cannot show.

    Args:
        problem: whose priors and residual count.
        x: where a fit ended (x,), on its best scale.
        powers: see `force_powers`.
    """
    if not powers.any():
        return 0.0
    known = (powers != 0) & np.array([c.is_constant for c in problem.coordinates])
    wrong = (np.sum((x[known] / problem.prior[known]) ** 2) + 1.0) / max(np.count_nonzero(known), 1)
    of_priors = np.sum((powers / problem.prior) ** 2)
    of_residual = max(best_scale(problem, x, powers)[1] - of_priors, 0.0)
    return float((of_priors / wrong + of_residual) ** -0.5)
