"""Rank effects cheaply: does what an effect would change look like what the refitted model leaves unexplained?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.coordinates import effect_coordinates, place_values, position
from flexarm_env.identify.data import Data
from flexarm_env.identify.least_squares import jacobian, minimise
from flexarm_env.identify.predict import torque_scale
from flexarm_env.identify.problem import Problem, rms_by_run
from flexarm_env.identify.refit import Refit, polish, refit

Floats = NDArray[np.float64]

#: Starts that are followed up for each effect.
STARTS_KEPT = 2
#: The signature's own estimate of an effect's size is trusted within these factors.
SMALLEST_FACTOR, LARGEST_FACTOR = 0.1, 4.0
ITERATIONS = 4
#: Process noise at which candidates are screened, over the rms of the drive's torque.
SCREENING_LEVEL = 0.01
#: Levels through which a candidate is refitted together with all constants.
CANDIDATE_LEVELS = (0.003, 0.0003)


@dataclass(frozen=True)
class Base:
    """A refitted arm at one level of process noise: its residual, and the Jacobian of its constants, orthonormal too."""

    problem: Problem
    x: Floats
    residual: Floats
    jacobian: Floats
    orthonormal: Floats


@dataclass(frozen=True)
class Signature:
    """How well an effect, started at some values, would explain the residual."""

    effect: str
    start: dict[str, float]
    explained: float


@dataclass(frozen=True)
class Trial:
    """An effect fitted with the constants moving along: the arm, and its cost on the fitted and the held-out part."""

    effect: str
    arm: Arm
    cost: float
    held_out: float


def screening_base(found: Refit, data: Data) -> Base:
    """Return the refitted arm's residual and Jacobian at the level at which candidates are screened."""
    torque_noise = max(SCREENING_LEVEL * torque_scale(found.arm, data), found.arm.constants["drive"]["torque_noise"])
    problem = Problem(found.arm, data, found.coordinates, torque_noise, np.ones((len(data.runs), len(data.signals))))
    problem.sigma = rms_by_run(problem.errors_of(found.arm), data)
    x = position(found.arm, found.coordinates)
    residual = problem.residual(x)
    slopes = jacobian(problem.residual, x, residual)
    prior = np.diag([1.0 / c.prior for c in found.coordinates])
    orthonormal = np.linalg.qr(np.vstack([slopes, prior]))[0][: len(residual)]
    return Base(problem, x, residual, slopes, orthonormal)


def candidates(arm: Arm) -> list[str]:
    """Return the effects that an arm could lack."""
    fine = arm.constants.get("beam", {}).get("elements", 0.0) >= 3
    return [n for n in arm.known if n not in arm.effects and arm.can_have(n) and not (n == "higher_modes" and fine)]


def signatures(base: Base, effect: str) -> list[Signature]:
    """Return the most promising starts of an effect, best first, by the share of the residual that each explains."""
    found = []
    for start in base.problem.arm.known[effect].starts():
        found += [s for s in (_signature(base, effect, values) for values in _by_sensor(base, effect, start)) if s]
    found.sort(key=lambda s: -s.explained)
    return found[:STARTS_KEPT]


def _by_sensor(base: Base, effect: str, start: dict[str, float]) -> list[dict[str, float]]:
    known = base.problem.arm.known[effect]
    if effect != "sensor_offset":
        return [start]
    sensors = base.problem.arm.sensors
    return [{key: (p.typical * 0.3 if key == signal else 0.0) for key, p in known.parameters.items()} for signal in sensors]


def _signature(base: Base, effect: str, start: dict[str, float]) -> Signature | None:
    known = base.problem.arm.known[effect]
    arm = base.problem.arm.with_effect(effect, **start)
    change = base.problem.residual_of(arm) - base.residual
    change = change - base.orthonormal @ (base.orthonormal.T @ change)
    left = base.residual - base.orthonormal @ (base.orthonormal.T @ base.residual)
    power = float(change @ change)
    if power <= 1e-12 * float(left @ left):
        return None
    factor = -float(change @ left) / power
    size = known.size()
    parameter = known.parameters[size]
    if factor < 0.0 and parameter.low >= 0.0:
        return Signature(effect, start, 0.0)
    explained = factor**2 * power / float(left @ left)
    values = dict(start)
    if parameter.null == 0.0 and known.fitted:
        scale = float(np.sign(factor) * np.clip(abs(factor), SMALLEST_FACTOR, LARGEST_FACTOR))
        for key, p in known.parameters.items():
            if p.null == 0.0:
                values[key] = min(max(values[key] * scale, p.low), p.high)
    return Signature(effect, values, explained)


def attempt(base: Base, signature: Signature | None) -> Trial:
    """Fit an effect from a start, or none, with the constants following along their known slopes."""
    arm = base.problem.arm
    name = "" if signature is None else signature.effect
    if signature is not None:
        arm = arm.with_effect(name, **signature.start)
    added = effect_coordinates(arm, name) if name else []
    coordinates = [*base.problem.coordinates, *added]
    problem = Problem(arm, base.problem.data, coordinates, base.problem.torque_noise, base.problem.sigma)
    prior = np.array([c.prior for c in coordinates])
    x = np.concatenate([base.x, position(arm, added)])
    solution = minimise(problem.residual, x, prior, ITERATIONS, frozen=base.jacobian, tolerance=1e-3)
    best = place_values(arm, coordinates, solution.x)
    held = Problem(best, base.problem.data, [], base.problem.torque_noise, base.problem.sigma, held_out=True)
    r = held.residual_of(best)
    return Trial(name, best, solution.cost, float(r @ r))


def refit_effect(effect: str, base: Refit, nominal: Arm, data: Data) -> Refit:
    """Return the refitted arm with an effect added and everything fitted again."""
    screening = screening_base(base, data)
    found = signatures(screening, effect)
    if found:
        start = min((attempt(screening, signature) for signature in found), key=lambda trial: trial.cost).arm
    else:
        start = base.arm.with_effect(effect)
    return polish(refit(start, nominal, data, CANDIDATE_LEVELS), nominal, data)


def best_trials(trials: Sequence[Trial]) -> list[Trial]:
    """Return the best trial of each effect, best effect first by the cost on the held-out part."""
    best: dict[str, Trial] = {}
    for trial in trials:
        if trial.effect not in best or trial.cost < best[trial.effect].cost:
            best[trial.effect] = trial
    return sorted(best.values(), key=lambda t: t.held_out)
