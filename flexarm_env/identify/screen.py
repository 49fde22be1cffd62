"""Rank effects cheaply: does what an effect would change look like what the refitted model leaves unexplained?"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.coordinates import effect_coordinates, place_values, position, reach_at
from flexarm_env.identify.data import Data
from flexarm_env.identify.least_squares import jacobian, minimise
from flexarm_env.identify.problem import Problem
from flexarm_env.identify.refit import Refit, as_it_is, polish, refit
from flexarm_env.identify.scales import torque_scale

Floats = NDArray[np.float64]

#: Share of the residual that an effect must explain by its signature to be fitted at all.
LEAST_EXPLAINED = 0.005
#: Starts whose size is scanned, and the factors.
STARTS_SCANNED = 2
SIZES = (0.15, 0.4, 0.75, 1.2, 2.5)
#: Of an effect with no more starts the first is tried at these shares of its size, too: a typical one may explain nothing.
FEW, SMALL = 2, (0.03, 0.003)
#: An effect that explains this share of what its secant promises grows in proportion; largest factor taken from a secant.
LINEAR, LARGEST_FACTOR = 0.7, 10.0
ITERATIONS = 4
#: Process noises at which candidates are screened, over the rms of the drive's torque: the largest at which the errors, rms over
#: the noise, exceed VISIBLE. More hides a small steady torque, less makes the errors of a model that is far off rough.
SCREENING_LEVELS, VISIBLE = (0.01, 0.003, 0.001, 0.0003), 1.5


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
    """How well an effect, started at some values, would explain the residual, and by what factor its size is off for that."""

    effect: str
    start: dict[str, float]
    explained: float
    factor: float = 1.0


@dataclass(frozen=True)
class Trial:
    """An effect fitted with the constants moving along: the arm, and its cost on the fitted and the held-out part."""

    effect: str
    arm: Arm
    cost: float
    held_out: float


def screening_bases(starts: Sequence[Refit], data: Data) -> list[Base]:
    """Return bases that weigh errors alike, so that what is tried from one can be held against what is tried from another."""
    bases = [screening_base(starts[0], data)]
    for start in starts[1:]:
        problem = replace(bases[0].problem, arm=start.arm)
        problem.prior = bases[0].problem.prior
        bases.append(_base(problem, start))
    return bases


def screening_base(found: Refit, data: Data, levels: Sequence[float] = SCREENING_LEVELS) -> Base:
    """Return the refitted arm's residual and Jacobian at the first of the levels at which something is left to explain."""
    scale, own = torque_scale(found.arm, data.runs), found.arm.constants["drive"]["torque_noise"]
    for level in levels:
        torque_noise = max(level * scale, own)
        problem = Problem(found.arm, data, found.coordinates, torque_noise, np.ones((len(data.runs), len(data.signals))))
        problem.weigh(found.arm)
        if torque_noise == own or np.sqrt(np.mean((problem.sigma / data.noise) ** 2)) > VISIBLE:
            break
    return _base(problem, found)


def _base(problem: Problem, found: Refit) -> Base:
    x = position(found.arm, problem.coordinates)
    residual = problem.residual(x)
    slopes = jacobian(problem.residual, x, found.solution.reach.now)
    prior = np.diag(1.0 / problem.prior)
    orthonormal = np.linalg.qr(np.vstack([slopes, prior]))[0][: len(residual)]
    return Base(problem, x, residual, slopes, orthonormal)


def candidates(arm: Arm) -> list[str]:
    """Return the effects that an arm could lack."""
    elements = arm.constants.get("beam", {}).get("elements", 0.0)
    lacking = [n for n, e in arm.known.items() if n not in arm.effects and arm.can_have(n) and elements <= e.most_elements]
    return [n for n in lacking if not arm.known[n].modifies or arm.known[n].modifies in arm.effects]


def signatures(base: Base, effect: str) -> list[Signature]:
    """Return the most promising start of an effect, if it explains anything of the residual.

    The effect's own starts are ranked by a finite secant; the best are tried at the size that it gives.
    """
    starts = starts_of(base, effect)
    if len(starts) <= FEW and base.problem.arm.known[effect].fitted:
        starts += [sized(base.problem.arm, effect, starts[0], share) for share in SMALL]
    secants = sorted((_secant(base, effect, start) for start in starts), key=lambda s: -s.explained)
    best = max((_at_its_size(base, s) for s in secants[:STARTS_SCANNED]), key=lambda s: s.explained)
    return [best] if best.explained > LEAST_EXPLAINED else []


def starts_of(base: Base, effect: str) -> list[dict[str, float]]:
    """Return the values from which an effect is tried, in the scales of the data."""
    return [values for start in base.problem.arm.known[effect].starts() for values in _by_sensor(base, effect, start)]


def first_start(arm: Arm, effect: str, scales: Mapping[str, float]) -> dict[str, float]:
    """Return the values from which an effect is tried first."""
    return _scaled(arm, effect, arm.known[effect].starts()[0], scales)


def _by_sensor(base: Base, effect: str, start: dict[str, float]) -> list[dict[str, float]]:
    """Return a start in the scales of the data; for offsets, one for each sensor."""
    known, data = base.problem.arm.known[effect], base.problem.data
    if known.per_sensor:
        noise = dict(zip(data.signals, data.noise, strict=True))
        return [{key: (float(noise[key]) if key == signal else 0.0) for key in known.parameters} for signal in noise]
    return [_scaled(base.problem.arm, effect, start, data.scales)]


def _scaled(arm: Arm, effect: str, start: Mapping[str, float], scales: Mapping[str, float]) -> dict[str, float]:
    """Return a start in the scales of the data, within the bounds."""
    parameters = arm.known[effect].parameters
    values = {key: p.typical for key, p in parameters.items()}
    values |= {key: value * parameters[key].scaled_by(scales) for key, value in start.items()}
    return {key: min(max(v, parameters[key].low), parameters[key].high) for key, v in values.items()}


def unexplained(base: Base, residual: Floats) -> Floats:
    """Return the residual without what the constants could explain."""
    left: Floats = residual - base.orthonormal @ (base.orthonormal.T @ residual)
    return left


def _secant(base: Base, effect: str, start: dict[str, float]) -> Signature:
    """What an effect would explain if its change of the residual grew in proportion to its size."""
    change = unexplained(base, base.problem.residual_of(base.problem.arm.with_effect(effect, **start)) - base.residual)
    left = unexplained(base, base.residual)
    power, total = float(change @ change), float(left @ left)
    if power <= 1e-12 * total:
        return Signature(effect, start, 0.0, 0.0)
    along = float(change @ left)
    phase = base.problem.arm.known[effect].scan_phase
    if along > 0.0 and phase:  # the sine wants to be turned round
        start = {**start, phase: start[phase] - float(np.copysign(np.pi, start[phase]))}
        along = -along
    return Signature(effect, start, along**2 / power / total, -along / power)


def _at_its_size(base: Base, secant: Signature) -> Signature:
    """Return an effect at the size that its secant gives, or, where that does not hold, at the best of a scan.

    The error of a gap or a delay has a narrow valley that no slope finds from outside.
    """
    factors = _factors(base, secant)
    if factors == (1.0,) or secant.explained == 0.0:
        return _at_size(base, secant, 1.0)
    found = [_as_it_is(secant)]
    if secant.factor > 0.0 or min(factors) < 0.0:
        found.append(_at_size(base, secant, float(np.clip(secant.factor, -LARGEST_FACTOR, LARGEST_FACTOR))))
        if found[-1].explained > LINEAR * secant.explained:
            return found[-1]
    return max(found + [_at_size(base, secant, factor) for factor in factors], key=lambda s: s.explained)


def _as_it_is(secant: Signature) -> Signature:
    """Return an effect at the size from which its secant was taken: the parabola along the secant at 1."""
    factor = secant.factor
    return Signature(secant.effect, secant.start, secant.explained * (2.0 * factor - 1.0) / factor**2)


def _factors(base: Base, signature: Signature) -> tuple[float, ...]:
    """Factors of an effect's size that are scanned: of both signs where it has two, one where it cannot be scaled."""
    effect = base.problem.arm.known[signature.effect]
    parameter = effect.parameters[effect.size()]
    if not effect.fitted:
        return (1.0,)
    return (*SIZES, *(-size for size in SIZES)) if parameter.low < 0.0 else SIZES


def sized(arm: Arm, effect: str, start: Mapping[str, float], factor: float) -> dict[str, float]:
    """Return a start with its effect so many times as strong, within bounds; what is absent at infinity is divided."""
    values = dict(start)
    for key, p in arm.known[effect].parameters.items():
        if p.null is not None:
            value = values[key] / factor if p.null == math.inf else values[key] * factor
            values[key] = min(max(value, p.low), p.high)
    return values


def _at_size(base: Base, signature: Signature, factor: float) -> Signature:
    values = sized(base.problem.arm, signature.effect, signature.start, factor)
    left = unexplained(base, base.problem.residual_of(base.problem.arm.with_effect(signature.effect, **values)))
    before = unexplained(base, base.residual)
    return Signature(signature.effect, values, 1.0 - float(left @ left) / float(before @ before))


def attempt(base: Base, signature: Signature | None) -> Trial:
    """Fit an effect from a start, or none, with the constants following along their known slopes."""
    arm = base.problem.arm
    name = "" if signature is None else signature.effect
    if signature is not None:
        arm = arm.with_effect(name, **signature.start)
    added = effect_coordinates(arm, name, base.problem.data.scales) if name else []
    coordinates = [*base.problem.coordinates, *added]
    problem = Problem(arm, base.problem.data, coordinates, base.problem.torque_noise, base.problem.sigma)
    prior = np.concatenate([base.problem.prior, [c.prior for c in added]])
    x = np.concatenate([base.x, position(arm, added)])
    reach = reach_at(added, x[len(base.x) :])
    solution = minimise(problem.residual, x, prior, reach, ITERATIONS, frozen=base.jacobian)
    best = place_values(arm, coordinates, solution.x)
    held = Problem(best, base.problem.data, [], base.problem.torque_noise, base.problem.sigma, held_out=True)
    r = held.residual_of(best)
    return Trial(name, best, solution.cost, float(r @ r))


def refit_effect(effect: str, base: Refit, nominal: Arm, data: Data) -> Refit:
    """Return the refitted arm with an effect added and everything fitted again."""
    bases = screening_bases((base, as_it_is(nominal, data)), data)
    trials = [attempt(b, signature) for b in bases for signature in signatures(b, effect)]
    start = min(trials, key=lambda trial: trial.held_out).arm if trials else base.arm.with_effect(effect)
    return polish(refit(start, nominal, data), nominal, data)


def best_trials(trials: Sequence[Trial]) -> list[Trial]:
    """Return the best trial of each effect, best effect first by the cost on the held-out part."""
    best: dict[str, Trial] = {}
    for trial in trials:
        if trial.effect not in best or trial.cost < best[trial.effect].cost:
            best[trial.effect] = trial
    return sorted(best.values(), key=lambda t: t.held_out)
