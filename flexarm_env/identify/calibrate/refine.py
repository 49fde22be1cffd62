"""Final Gauss–Newton steps along weakly observable directions.

Levenberg–Marquardt damps each value by how much it changes the motion. Values that change it one by one, and hardly together,
stay where they are. Observer-corrected replays are smooth enough for narrow differences, so the final steps go through them to
the free replay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.calibrate.common_scale import best_scale, force_powers
from flexarm_env.identify.calibrate.least_squares import Residuals, cost_of, secant_correction, slopes
from flexarm_env.identify.calibrate.objective import Objective, objective_at
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.settings import LEAST_NORM, Refining

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Refined:
    """Where final steps ended.

    Attributes:
        x: (x,).
        residual: there (rows,).
        cost: sum of squares of residual and prior.
        jacobian: (rows, x) of narrow differences, corrected along the steps; None where none were taken.
        scatter: (x,) standard deviation of the minima that were found, each on its best scale; none where there is one.
    """

    x: Floats
    residual: Floats
    cost: float
    jacobian: Floats | None
    scatter: Floats | float = 0.0


def gauss_newton(residuals: Residuals, x: Floats, prior: Floats, numbers: Refining) -> Refined:
    """Minimise |residual(x)|² + |x / prior|² by damped Gauss–Newton steps, which each correct the Jacobian.

    The steps end where one promises less than chance, or gives much less than it promised. The Jacobian is then computed anew if
    they lowered the cost by more than chance.

    Args:
        residuals: whitened residuals (rows,) at some points.
        x: where to start (x,).
        prior: standard deviation of each x around 0.
        numbers: differences, dampings and stopping rule.
    """
    r = residuals([x])[0]
    here = Refined(x, r, cost_of(r, x, prior), None)
    for _ in range(numbers.iterations):
        j = slopes(residuals, here.x, here.residual, np.full(len(x), numbers.difference))
        before, here, keeps = here.cost, replace(here, jacobian=j), True
        while keeps:
            ahead, promised = _step(residuals, here, prior, numbers)
            keeps, here = here.cost - ahead.cost > numbers.kept * promised, ahead
        if promised < numbers.least_promise or before - here.cost < numbers.least_decrease:
            break
    return here


def _step(residuals: Residuals, here: Refined, prior: Floats, numbers: Refining) -> tuple[Refined, float]:
    """Take the least damped step that lowers the cost; also give the decrease that an undamped one promises."""
    assert here.jacobian is not None
    j = here.jacobian * prior
    strengths, axes = np.linalg.eigh(j.T @ j)
    strengths = np.maximum(strengths, 0.0)  # rounding makes the least of very different ones negative
    slope = axes.T @ (j.T @ here.residual + here.x / prior)
    promised = float(np.sum(slope**2 / (strengths + 1.0)))
    for damping in numbers.dampings if promised >= numbers.least_promise else ():
        step = -prior * (axes @ (slope / (strengths + 1.0 + damping)))
        left = residuals([here.x + step])[0]
        cost = cost_of(left, here.x + step, prior)
        if cost < here.cost:
            missed = left - here.residual - here.jacobian @ step
            correction = secant_correction(missed, step, np.diag(j.T @ j) / prior**2 + prior**-2.0)
            return Refined(here.x + step, left, cost, here.jacobian + correction), promised
    return here, promised


def refine(objective: Objective, x: Floats) -> Refined:
    """Move x to the best common scale and, where the model lacks nothing, on along weakly observable directions.

    A replay is rough along those directions, and a fit ends in a local minimum. So two are sought: through corrected replays, and
    from x itself. Where they differ, another is sought through corrected replays. Where the best still leaves more than a
    corrected replay, two more are sought from some way to either side.

    Args:
        objective: weighted by the errors where the fit ended, at the arm's own torque noise.
        x: where the fit ended (x,).
    """
    dataset = objective.dataset
    errors, process_noise = dataset.settings.errors, dataset.settings.process_noise
    powers = force_powers(objective.arm, objective.parameters)
    x = best_scale(objective, x, powers)
    if not len(x) or objective.excess_factor > errors.close:
        return _at(objective, x, None)
    *smooth, first = _descend(objective, x, process_noise.refinement)
    if not smooth:
        return _along_scale(objective, first.found, powers)
    ends = [first, *_descend(objective, x, ())]
    if max(end.error for end in ends) > errors.converged * _best(ends).error:
        *_, again = _descend(objective, first.found.x, process_noise.refinement)
        ends.append(again)
    best = _best(ends)
    if best.error > errors.converged * min(end.error for end in smooth):
        aside = dataset.settings.refining.aside * objective.weights.prior * smooth[0].weakest_direction
        starts = (best.found.x - aside, best.found.x + aside)
        ends += [_descend(objective, start, process_noise.refinement_aside)[-1] for start in starts]
        best = _best(ends)
    found = _along_scale(objective, best.found, powers)
    alike = [end for end in ends if end is not best and end.error <= dataset.settings.refining.alike * best.error]
    minima = [found.x, *(best_scale(objective, end.found.x, powers) for end in alike)]
    return replace(found, scatter=np.std(minima, axis=0, ddof=1) if alike else 0.0)


def _along_scale(objective: Objective, found: Refined, powers: NDArray[np.int64]) -> Refined:
    """Move to the best common scale; where that gains more than two ends of one fit differ by, take more steps, in turn."""

    def at_best_scale(here: Refined) -> Refined:
        x = best_scale(objective, here.x, powers)
        return here if np.array_equal(x, here.x) else _at(objective, x, here.jacobian)

    least = objective.dataset.settings.errors.converged**2
    ahead = at_best_scale(found)
    while found.cost > least * ahead.cost:
        found, ahead = ahead, at_best_scale(_descend(objective, ahead.x, ())[-1].found)
    return ahead


def _at(objective: Objective, x: Floats, near: Floats | None) -> Refined:
    """Evaluate an objective at x, with a Jacobian from near by."""
    residual = objective.residual(x)
    return Refined(x, residual, cost_of(residual, x, objective.weights.prior), near)


@dataclass(frozen=True)
class _End:
    """Where final steps at one level of process noise ended."""

    level: Objective
    found: Refined

    @property
    def error(self) -> float:
        """The rms error over the noise."""
        dataset = self.level.dataset
        errors = self.found.residual * self.level.rows_of(self.level.weights.sigma / dataset.noise)
        return float(np.sqrt(np.sum(errors**2) / dataset.readings(held_out=False)))

    @property
    def weakest_direction(self) -> Floats:
        """The least observable direction (x,) but for the common scale: of unit length, in priors' standard deviations."""
        assert self.found.jacobian is not None
        prior = self.level.weights.prior
        j = self.found.jacobian * prior
        onto_scale = force_powers(self.level.arm, self.level.parameters) / prior
        length = float(np.linalg.norm(onto_scale))
        j -= np.outer(j @ onto_scale, onto_scale) / max(length**2, LEAST_NORM)
        _, axes = np.linalg.eigh(j.T @ j)
        return axes[:, 1 if length and len(prior) > 1 else 0]  # the scale itself comes first


def _best(ends: Sequence[_End]) -> _End:
    return min(ends, key=lambda end: end.found.cost)


def _descend(objective: Objective, x: Floats, levels: Sequence[float]) -> list[_End]:
    """Minimise through levels of process noise, over the rms torque of the drive, and then at the arm's own."""
    scale, own = torque_scale(objective.arm, objective.dataset.runs), objective.torque_noise
    numbers, ends = objective.dataset.settings.refining, []
    for noise in [*(level * scale for level in levels if level * scale > own), own]:
        level = objective if noise == own else _at_level(objective, x, noise)
        ends.append(_End(level, gauss_newton(level.residuals, x, level.weights.prior, numbers)))
        x = ends[-1].found.x
    return ends


def _at_level(objective: Objective, x: Floats, torque_noise: float) -> Objective:
    level = objective_at(objective.arm, objective.dataset, objective.parameters, torque_noise)
    level = replace(level, starts=objective.starts)
    return level.weighted_by(objective.parameters.apply(objective.arm, x), narrow_priors=False)
