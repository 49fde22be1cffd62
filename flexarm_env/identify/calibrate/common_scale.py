"""The common scale of torques, inertias and stiffness, and of the inverse of strain gages' gains.

No motion shows it. Only priors determine it, or a known payload, or the voltage that a motor of known resistance induces. A fit
does not find its way along it: differences of one value at a time are not exact enough to show that nothing changes.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.least_squares import cost_of, secant_correction
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


@dataclass(frozen=True)
class AlongScale:
    """Derivatives by the logarithm of the common scale; all 0 where there is none.

    Attributes:
        x: of the fitted values (x,).
        residual: of the residual (rows,).
        prior: standard deviation of each x (x,).
    """

    x: Floats
    residual: Floats
    prior: Floats

    @property
    def is_open(self) -> bool:
        """Whether there is a common scale."""
        return bool(self.x.any())

    @property
    def of_priors(self) -> float:
        """Information of the priors on the scale: the inverse of its variance, were there no readings."""
        return float(np.sum((self.x / self.prior) ** 2))

    @property
    def share(self) -> Floats:
        """The change of the scale (x,) by a change of each x, by the priors' weights."""
        return self.x / self.prior**2 / max(self.of_priors, LEAST_NORM)

    @property
    def beside(self) -> Floats:
        """The matrix (x, x) that takes the common scale out of a change of x."""
        return np.eye(len(self.x)) - np.outer(self.x, self.share)

    def correct(self, slopes: Floats) -> Floats:
        """Make slopes of the residual (rows, x) exact along the scale."""
        if not self.is_open:
            return slopes
        return slopes + secant_correction(self.residual - slopes @ self.x, self.x, self.prior**-2.0)


def along_scale(objective: Objective, x: Floats, powers: NDArray[np.int64]) -> AlongScale:
    """Differentiate an objective along the common scale.

    Args:
        objective: gives the priors and the residual.
        x: where (x,).
        powers: see `force_powers`.
    """
    prior = objective.weights.prior
    if not powers.any():
        return AlongScale(np.zeros(len(x)), np.zeros(0), prior)
    step = objective.dataset.settings.refining.scale_step
    above, below = (rescale(objective.parameters, x, powers, shift) for shift in (step, -step))
    change = (objective.residual(above) - objective.residual(below)) / (2.0 * step)
    return AlongScale((above - below) / (2.0 * step), np.nan_to_num(change), prior)


def best_scale(objective: Objective, x: Floats, powers: NDArray[np.int64]) -> Floats:
    """Move x to the scale of least cost.

    Args:
        objective: gives the priors and the residual.
        x: end of a fit (x,).
        powers: see `force_powers`.
    """

    def cost(shift: float) -> float:
        there = rescale(objective.parameters, x, powers, shift)
        return cost_of(objective.residual(there), there, objective.weights.prior)

    if not powers.any():
        return x
    numbers = objective.dataset.settings.refining
    step, furthest = numbers.scale_step, numbers.scale_furthest
    below, here, above = (cost(shift) for shift in (-step, 0.0, step))
    curvature = (below + above - 2.0 * here) / (2.0 * step**2)
    if not curvature > 0.0:
        return x
    shift = float(np.clip((below - above) / (4 * step * curvature), -furthest, furthest))
    return rescale(objective.parameters, x, powers, shift) if cost(shift) < here else x


def scale_deviation(along: AlongScale, parameters: FitParameters, x: Floats, spread: Floats) -> float:
    """Estimate the standard deviation of the scale's logarithm.

    Priors are widened by the ratio at which the constants prove to be wrong (Birge, Phys. Rev. 40 (1932) 207). One more constant,
    off by one standard deviation of its prior, stands for the little evidence of so few.

    Args:
        along: derivatives along the scale.
        parameters: that were fitted.
        x: end of a fit (x,), on its best scale.
        spread: covariance of x by residual and priors (x, x), in which other values make up for what the scale changes.
    """
    if not along.is_open:
        return 0.0
    known = (along.x != 0) & parameters.constant
    wrong = (np.sum((x[known] / along.prior[known]) ** 2) + 1.0) / max(np.count_nonzero(known), 1)
    of_residual = max(1.0 / float(along.share @ spread @ along.share) - along.of_priors, 0.0)
    return float((along.of_priors / wrong + of_residual) ** -0.5)
