"""Refit an arm's constants (and effects): from nudged replays to free ones, so that no local minimum holds it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.common_scale import force_powers, scale_deviation
from flexarm_env.identify.coordinates import (
    Coordinate,
    base_coordinates,
    effect_coordinates,
    place_values,
    position,
    reach_at,
)
from flexarm_env.identify.data import Data, everything
from flexarm_env.identify.least_squares import Solution, covariance, jacobian, minimise
from flexarm_env.identify.problem import Problem, Score, rms_by_run, score
from flexarm_env.identify.results import Estimate
from flexarm_env.identify.scales import torque_scale
from flexarm_env.identify.settle import DIFFERENCE, settled

Floats = NDArray[np.float64]
Progress = Callable[[float, str], None]

#: Process noise of the levels that a fit goes through, over the rms of the drive's torque.
LEVELS = (0.03, 0.003, 0.0003)
#: And of one for which those are too few.
MORE_LEVELS = (0.3, *LEVELS)
#: A refit whose error on the fitted part is below this is done.
WELL = 1.02
#: Error in windows above which a model is far off, how often one that stays so is refitted once more, and what counts as near.
FAR_OFF, MOST_AGAIN, NEAR = 3.0, 4, (1.03, 1.4)
#: Relative decrease of the cost at which a level is left, and at which the last one is.
ON_THE_WAY, AT_THE_END = 1e-2, 1e-4
#: Passes at the end: the first weighs the signals by errors that it then removes, the last goes by narrow differences.
PASSES = 3
#: Iterations of a pass when only the held-out part is new.
LAST_ITERATIONS = 2
QUANTILE_90 = 1.6449
#: Relative standard deviation that no value beats: no model is more exact than this.
BEST_MODEL = 0.005
#: Length [s] of the blocks over which residuals may hang together.
BLOCK = 0.25


@dataclass
class Refit:
    """A refitted arm, its coordinates and where the fit ended; how far it moved when the held-out part came in."""

    arm: Arm
    coordinates: list[Coordinate]
    solution: Solution
    problem: Problem
    moved: Floats | None = None


def free_coordinates(arm: Arm, nominal: Arm, data: Data) -> list[Coordinate]:
    """Return everything that a fit of the arm moves: constants first, then effects that the nominal arm lacks."""
    added = [name for name in arm.effects if name not in nominal.effects]
    constants = base_coordinates(arm, nominal, data.scales)
    return constants + [c for name in added for c in effect_coordinates(arm, name, data.scales)]


def refit(
    arm: Arm,
    nominal: Arm,
    data: Data,
    levels: Sequence[float] = LEVELS,
    iterations: int = 6,
    held: bool = True,
    passes: int = PASSES,
) -> Refit:
    """Fit all coordinates of an arm through the levels, then at the arm's own torque noise.

    Args:
        arm: where to start.
        nominal: whose values the priors are centred on.
        data: the recordings.
        levels: of process noise, over the rms of the drive's torque.
        iterations: for each level.
        held: whether constants are held close to their priors while the model is far off.
        passes: at the arm's own torque noise.
    """
    scale, own = torque_scale(arm, data.runs), arm.constants["drive"]["torque_noise"]
    noises = [level * scale for level in levels if level * scale > own]
    noises += [own] * (passes if noises else max(passes, 1))
    tolerances = [ON_THE_WAY] * (len(noises) - 1) + [AT_THE_END]
    coordinates = free_coordinates(arm, nominal, data)
    x = position(arm, coordinates)
    reach = reach_at(coordinates, x)
    for number, (noise, tolerance) in enumerate(zip(noises, tolerances, strict=True), start=1):
        problem = Problem(arm, data, coordinates, noise, np.ones((len(data.runs), len(data.signals))))
        problem.weigh(place_values(arm, coordinates, x), held)
        reach = reach.narrowed() if number == len(noises) >= PASSES else reach
        solution = minimise(problem.residual, x, problem.prior, reach, iterations, tolerance=tolerance)
        x, reach = solution.x, solution.reach
    return Refit(place_values(arm, coordinates, x), coordinates, solution, problem)


def as_it_is(arm: Arm, data: Data) -> Refit:
    """Return an arm as if it had been refitted and nothing had moved."""
    coordinates = free_coordinates(arm, arm, data)
    problem = Problem(arm, data, coordinates, 0.0, np.ones((len(data.runs), len(data.signals))))
    x = position(arm, coordinates)
    return Refit(arm, coordinates, Solution(x, np.inf, np.zeros(0), np.zeros((0, len(x))), reach_at(coordinates, x)), problem)


def best_refit(nominal: Arm, data: Data) -> Refit:
    """Refit the constants; where they were right already, so that nothing is gained, stay near them."""
    before = score(nominal, data, held_out=False)
    found, after = refit_from(nominal, nominal, data)
    return found if after.windows <= before.windows else refit(nominal, nominal, data, ())


def refit_from(arm: Arm, nominal: Arm, data: Data) -> tuple[Refit, Score]:
    """Return a refit that begins with this arm, and its error on the fitted part.

    Where a model ends off but not so far that something must be missing, constants may hold each other up. With more feedback at
    first they do not; the refit that ends at the lower error is returned.
    """
    found = refit(arm, nominal, data)
    after = score(found.arm, data, held_out=False)
    if not NEAR[1] < after.windows < FAR_OFF:
        return found, after
    other = refit(arm, nominal, data, MORE_LEVELS)
    then = score(other.arm, data, held_out=False)
    return (other, then) if then.windows < after.windows else (found, after)


def polish(found: Refit, nominal: Arm, data: Data) -> Refit:
    """Return a refit as far as it goes, from where it ended or from the nominal constants.

    Where the model stays far off, the error is so rough that one more refit may end at half of it; where little is left, as with
    play between gears, one more may end at the noise.
    """
    found = or_from_nominal(found, nominal, data)
    now = score(found.arm, data, held_out=False)
    near = NEAR[0] < now.windows < NEAR[1]
    for levels in (LEVELS, LEVELS[-1:]) if near else (LEVELS,) * MOST_AGAIN:
        if not near and now.windows < FAR_OFF:
            break
        other = refit(found.arm, nominal, data, levels)
        then = score(other.arm, data, held_out=False)
        if then.windows * then.free_run < now.windows * now.free_run:
            found, now = other, then
        elif not near:
            break
    return found


def or_from_nominal(found: Refit, nominal: Arm, data: Data) -> Refit:
    """Return the better of a refit and of another that starts from the nominal constants with its effects.

    What the constants did to make up for a missing effect may have led them where there is no way back.
    """
    now = score(found.arm, data, held_out=False)
    if now.windows < WELL:
        return found
    other, then = refit_from(with_effects_of(found.arm, nominal), nominal, data)
    return other if then.windows * then.free_run < now.windows * now.free_run else found


def with_effects_of(arm: Arm, nominal: Arm) -> Arm:
    """Return the nominal arm with what another has beside its effects."""
    added = {name: arm.effects[name] for name in arm.effects if name not in nominal.effects}
    return replace(nominal, effects={**nominal.effects, **added})


def put_back(found: Refit, nominal: Arm, strayed: float) -> Arm:
    """Return the arm with those constants as they were nominally that moved by more standard deviations of their priors.

    Where none did, all of them: so little may make up for an effect, too, and what is right is near.
    """
    pairs = [(c, abs(x) / c.prior) for c, x in zip(found.coordinates, found.solution.x, strict=True) if c.is_constant]
    far = [c.path for c, moved in pairs if moved > strayed] or [c.path for c, _ in pairs]
    return found.arm.with_values({path: nominal.value(path) for path in far})


def with_all(found: Refit, nominal: Arm, data: Data) -> Refit:
    """Return the refit gone on with on all of the data: what is kept once nothing is to be judged any more."""
    whole = everything(data)
    problem = Problem(found.arm, whole, found.coordinates, found.problem.torque_noise, np.ones_like(found.problem.sigma))
    problem.weigh(found.arm, held=False)
    x = position(found.arm, found.coordinates)
    solution = minimise(problem.residual, x, problem.prior, found.solution.reach, LAST_ITERATIONS, tolerance=AT_THE_END)
    moved = solution.x - x
    solution.x = settled(problem, solution.x)
    arm = place_values(found.arm, found.coordinates, solution.x)
    return Refit(arm, found.coordinates, solution, problem, moved)


def scatter(found: Refit, powers: NDArray[np.int64]) -> Floats:
    """Return the variance of each x (x,) where a refit ended, weighted by what it left, but for the common scale of forces.

    By differences as wide as the fit's and by exact ones, whichever is more: wide ones find motion where values that change
    together leave none, exact ones miss what sticking hides.

    Args:
        found: the refit.
        powers: how each x goes with forces (x,).
    """
    problem, x = found.problem, found.solution.x
    problem.sigma = rms_by_run(problem.errors_of(found.arm), problem.data)
    prior = np.array([c.prior for c in found.coordinates])
    block = max(int(BLOCK / problem.data.interval), 1) * len(problem.data.signals)
    residual, onto_scale = problem.residual(x), powers / prior**2
    rest = np.eye(len(x)) - np.outer(powers, onto_scale) / max(onto_scale @ powers, 1e-300)
    variances = []
    for steps in (found.solution.reach.now, np.full(len(x), DIFFERENCE)):
        spread = covariance(jacobian(problem.residual, x, steps), residual, prior, block)
        variances.append(np.diag(rest @ spread @ rest.T))
    largest: Floats = np.maximum.reduce([*variances, np.zeros(len(x))])
    return largest


def estimates(found: Refit, nominal: Arm) -> list[Estimate]:
    """Return every fitted value with its 90 % interval.

    Scatter of the fit (sandwich), how far the value moved when the held-out part came in, and what no model beats.
    """
    powers = force_powers(found.arm, found.coordinates)
    variance = scatter(found, powers) + (0.0 if found.moved is None else found.moved**2)
    common = scale_deviation(found.problem, found.solution.x, powers)
    relative = np.hypot(BEST_MODEL, common * np.abs(powers))
    sizes = [
        abs(c.value(float(x))) / c.scale if c.scale else 1.0 for c, x in zip(found.coordinates, found.solution.x, strict=True)
    ]
    least = relative * np.array(sizes)
    sigma = np.sqrt(variance + np.square(least))
    out = []
    for c, x, s in zip(found.coordinates, found.solution.x, sigma, strict=True):
        low, high = sorted((c.value(float(x - QUANTILE_90 * s)), c.value(float(x + QUANTILE_90 * s))))
        section, *rest = c.path.split(".")
        known = section != "effects" or rest[0] in nominal.effects
        before = nominal.value(c.path) if known else float(nominal.known[rest[0]].parameters[rest[1]].null or 0.0)
        out.append(Estimate(c.path, c.value(float(x)), low, high, nominal.parameter(c.path).unit, before))
    return out
