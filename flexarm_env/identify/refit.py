"""Refit an arm's constants (and effects): from nudged replays to free ones, so that no local minimum holds it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.coordinates import Coordinate, base_coordinates, effect_coordinates, place_values, position
from flexarm_env.identify.data import Data
from flexarm_env.identify.least_squares import Solution, covariance, jacobian, minimise
from flexarm_env.identify.predict import torque_scale
from flexarm_env.identify.problem import Problem, rms_by_run, score
from flexarm_env.identify.results import Estimate

Floats = NDArray[np.float64]
Progress = Callable[[float, str], None]

#: Process noise of the levels that a fit goes through, over the rms of the drive's torque.
LEVELS = (0.03, 0.003, 0.0003)
QUANTILE_90 = 1.6449
#: Length [s] of the blocks over which residuals may hang together.
BLOCK = 0.25


@dataclass
class Refit:
    """A refitted arm, its coordinates and where the fit ended."""

    arm: Arm
    coordinates: list[Coordinate]
    solution: Solution
    problem: Problem


def free_coordinates(arm: Arm, nominal: Arm) -> list[Coordinate]:
    """Return everything that a fit of the arm moves: constants first, then effects that the nominal arm lacks."""
    added = [name for name in arm.effects if name not in nominal.effects]
    return base_coordinates(arm, nominal) + [c for name in added for c in effect_coordinates(arm, name)]


def refit(
    arm: Arm, nominal: Arm, data: Data, levels: Sequence[float] = LEVELS, iterations: int = 6, last: bool = True
) -> Refit:
    """Fit all coordinates of an arm through the levels, then at the arm's own torque noise.

    Args:
        arm: where to start.
        nominal: whose values the priors are centred on.
        data: the recordings.
        levels: of process noise, over the rms of the drive's torque.
        iterations: for each level.
        last: whether to end with the arm's own torque noise (none: free replays).
    """
    scale = torque_scale(arm, data)
    noises = [level * scale for level in levels]
    if last:  # twice, since the first pass weighs the signals by errors that it then removes
        noises += [arm.constants["drive"]["torque_noise"]] * 2
    coordinates = free_coordinates(arm, nominal)
    x = position(arm, coordinates)
    prior = np.array([c.prior for c in coordinates])
    for noise in noises:
        problem = Problem(arm, data, coordinates, noise, np.ones((len(data.runs), len(data.signals))))
        problem.sigma = rms_by_run(problem.errors_of(place_values(arm, coordinates, x)), data)
        solution = minimise(problem.residual, x, prior, iterations)
        x = solution.x
    return Refit(place_values(arm, coordinates, x), coordinates, solution, problem)


def best_refit(nominal: Arm, data: Data) -> Refit:
    """Refit the constants; where they were right already, so that nothing is gained, stay near them."""
    found = refit(nominal, nominal, data)
    if score(found.arm, data, held_out=False).windows > score(nominal, data, held_out=False).windows:
        found = refit(nominal, nominal, data, ())
    return found


def polish(found: Refit, nominal: Arm, data: Data) -> Refit:
    """Return the better of a refit and of another that starts from the nominal constants with its effects.

    What the constants did to make up for a missing effect may have led them where there is no way back.
    """
    added = {name: found.arm.effects[name] for name in found.arm.effects if name not in nominal.effects}
    start = replace(nominal, effects={**nominal.effects, **added})
    other = refit(start, nominal, data)
    if score(other.arm, data, held_out=False).windows < score(found.arm, data, held_out=False).windows:
        return other
    return found


def at_solution(found: Refit) -> Refit:
    """Return the refit with its Jacobian where it ended, weighted by what it left: what intervals are made of."""
    problem = found.problem
    x = found.solution.x
    problem.sigma = rms_by_run(problem.errors_of(found.arm), problem.data)
    residual = problem.residual(x)
    solution = replace(found.solution, residual=residual, jacobian=jacobian(problem.residual, x, residual))
    return replace(found, solution=solution)


def estimates(found: Refit, nominal: Arm) -> list[Estimate]:
    """Return every fitted value with its 90 % interval."""
    found = at_solution(found)
    prior = np.array([c.prior for c in found.coordinates])
    block = max(int(BLOCK / found.problem.data.interval), 1) * len(found.problem.data.signals)
    spread = covariance(found.solution.jacobian, found.solution.residual, prior, block)
    sigma = np.sqrt(np.maximum(np.diag(spread), 0.0))
    out = []
    for c, x, s in zip(found.coordinates, found.solution.x, sigma, strict=True):
        low, high = sorted((c.value(float(x - QUANTILE_90 * s)), c.value(float(x + QUANTILE_90 * s))))
        section, *rest = c.path.split(".")
        known = section != "effects" or rest[0] in nominal.effects
        before = nominal.value(c.path) if known else float(nominal.known[rest[0]].parameters[rest[1]].null or 0.0)
        out.append(Estimate(c.path, c.value(float(x)), low, high, nominal.parameter(c.path).unit, before))
    return out
