"""Signatures of effects: the change of the residual that each would make, orthogonal to the constants' Jacobian."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.least_squares import jacobian
from flexarm_env.identify.calibrate.objective import Objective, ObserverBank, objective_at
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.select.starts import Change, changes_in_proportion, has_two_signs, sized, some_starts_of, starts_of
from flexarm_env.identify.settings import Screening

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Baseline:
    """A calibrated arm at one level of process noise, against which effects are screened.

    Attributes:
        objective: at the arm.
        x: the arm's values (x,).
        residual: (rows,).
        jacobian: of the arm's values (rows, x).
        orthonormal: (rows, x) basis of the changes that the values can make under their priors.
    """

    objective: Objective
    x: Floats
    residual: Floats
    jacobian: Floats
    orthonormal: Floats

    @property
    def arm(self) -> Arm:
        """The calibrated arm."""
        return self.objective.arm

    @property
    def numbers(self) -> Screening:
        """Numbers of the screening."""
        return self.objective.dataset.settings.screening

    @functools.cached_property
    def left(self) -> Floats:
        """The part of the residual (rows,) that no change of the values explains."""
        return self.unexplained(self.residual)

    @functools.cached_property
    def left_square(self) -> float:
        """Sum of its squares."""
        return float(self.left @ self.left)

    def square_unexplained(self, residual: Floats) -> float:
        """Compute the sum of squares of the part of a residual (rows,) that no change of the values explains."""
        along = self.orthonormal.T @ residual
        return float(residual @ residual - along @ along)

    def unexplained(self, residual: Floats) -> Floats:
        """Project a residual (rows,) onto the complement of the changes that the constants could make."""
        left: Floats = residual - self.orthonormal @ (self.orthonormal.T @ residual)
        return left

    def change(self, effect: str, values: dict[str, float]) -> Floats:
        """Compute the change of the residual (rows,) that an effect makes."""
        return self.residual_with(effect, values) - self.residual

    def residual_with(self, effect: str, values: dict[str, float]) -> Floats:
        """Compute the residual (rows,) of the arm with an effect; starts are so far apart that each has observers of its own."""
        return self.objective.residual_by_own_observers(self.arm.with_effect(effect, **values))


@dataclass(frozen=True)
class Signature:
    """An effect at the values from which it promises most.

    Attributes:
        effect: its name.
        start: its values.
        explained: share of the residual that it would explain there.
        factor: by which its size would have to change for that.
    """

    effect: str
    start: dict[str, float]
    explained: float
    factor: float = 1.0


def baseline(found: Calibration, dataset: Dataset, levels: Sequence[float] | None = None) -> Baseline:
    """Build the baseline of a calibrated arm at the first level of process noise at which something is left to explain.

    Args:
        found: the calibrated arm.
        dataset: the recordings.
        levels: over the rms torque of the drive; those of `process_noise.screening` if left out.
    """
    settings = dataset.settings
    scale, own = torque_scale(found.arm, dataset.runs), found.arm.constants["drive"]["torque_noise"]
    for level in settings.process_noise.screening if levels is None else levels:
        torque_noise = max(level * scale, own)
        objective = objective_at(found.arm, dataset, found.parameters, torque_noise, reduced=True).weighted_by(found.arm)
        if torque_noise == own or objective.excess_factor > settings.screening.visible:
            break
    return baseline_of(objective, found.solution.steps.now)


def baselines(starts: Sequence[Calibration], dataset: Dataset) -> list[Baseline]:
    """Build baselines that weigh errors alike, so that candidates from one can be compared with candidates from another."""
    first = baseline(starts[0], dataset)
    alike = [replace(first.objective, arm=start.arm, observers=ObserverBank()) for start in starts[1:]]
    return [
        first,
        *(baseline_of(objective, start.solution.steps.now) for objective, start in zip(alike, starts[1:], strict=True)),
    ]


def baseline_of(objective: Objective, steps: Floats) -> Baseline:
    """Build the baseline of an objective's own arm, with differences over steps (x,)."""
    x = objective.parameters.position(objective.arm)
    residual = objective.residual(x)
    slopes = jacobian(objective.residuals, x, steps)
    prior = np.diag(1.0 / objective.weights.prior)
    orthonormal = np.linalg.qr(np.vstack([slopes, prior]))[0][: len(residual)]
    return Baseline(objective, x, residual, slopes, orthonormal)


def signatures(base: Baseline, effect: str) -> list[Signature]:
    """Find the most promising start of an effect, if it explains anything of the residual of an arm without it."""
    return [found for _, found in promising([base], effect)]


def promising(bases: Sequence[Baseline], effect: str, briefly: bool = False) -> list[tuple[Baseline, Signature]]:
    """Find the baseline and the start of an effect from which it promises to leave least, if it explains anything there.

    The effect's own starts are ranked by a finite secant. The best are tried at the size that it gives.

    Args:
        bases: the arm without the effect, with other constants each.
        effect: its name.
        briefly: whether few starts are tried, and their secants' promises stand untried, as where only noise is left.
    """
    numbers = bases[0].numbers

    def rest(pair: tuple[Baseline, Signature]) -> float:
        return (1.0 - pair[1].explained) * pair[0].left_square

    pairs = sorted([(base, secant) for base in bases for secant in _secants(base, effect, briefly)], key=rest)
    if not briefly:
        pairs = [(base, _at_its_size(base, secant)) for base, secant in pairs[: numbers.starts_scanned]]
    best = min(pairs, key=rest)
    return [best] if best[1].explained > numbers.least_explained else []


def _secants(base: Baseline, effect: str, briefly: bool) -> list[Signature]:
    """Extrapolate what an effect explains from each of its starts; of few, briefly."""
    left, find = base.left, some_starts_of if briefly else starts_of

    def change_by(values: dict[str, float]) -> Floats:
        return base.unexplained(base.change(effect, values))

    starts = find(base.arm, effect, base.objective.dataset)
    tried = (changes_in_proportion(base.arm, effect, start, change_by, left, base.objective.dataset) for start in starts)
    changes = [change for of_start in tried for change in of_start]
    found = [_secant(base, effect, start, change, left) for start, change in changes]
    return found + _with_phases_between(base, effect, changes, left)


def _with_phases_between(base: Baseline, effect: str, changes: Sequence[Change], left: Floats) -> list[Signature]:
    """Combine the changes of a sine and of the cosine beside it into that of the phase between them which explains most.

    A sine of any phase is a sum of both, and so is its change. By one of them alone, a wrong period may explain more.
    """
    phase = base.arm.known[effect].scan_phase
    if not phase:
        return []
    size, total, found = base.arm.known[effect].size_parameter(), float(left @ left), []
    sines, cosines = ([one for one in changes if (one[0][phase] == 0.0) is wanted] for wanted in (True, False))
    for sine, of_sine in sines:
        beside = [one for one in cosines if all(one[0][key] == sine[key] for key in sine if key not in (phase, size))]
        for cosine, of_cosine in beside[:1]:
            each = np.column_stack([of_sine / sine[size], of_cosine / cosine[size]])
            along, across = np.linalg.lstsq(each, -left, rcond=None)[0]
            after = left + each @ (along, across)
            start = {**sine, phase: float(np.arctan2(across, along))}
            factor = float(np.hypot(along, across)) / sine[size]
            if factor > 0.0:
                found.append(Signature(effect, start, 1.0 - float(after @ after) / total, factor))
    return found


def _secant(base: Baseline, effect: str, start: dict[str, float], change: Floats, left: Floats) -> Signature:
    """Extrapolate an effect's explained share, as if its change of the residual grew in proportion to its size."""
    power, total = float(change @ change), float(left @ left)
    if power <= base.numbers.least_change * total:
        return Signature(effect, start, 0.0, 0.0)
    along = float(change @ left)
    phase = base.arm.known[effect].scan_phase
    if along > 0.0 and phase:  # the sine turned round
        start = {**start, phase: start[phase] - float(np.copysign(np.pi, start[phase]))}
        along = -along
    return Signature(effect, start, along**2 / power / total, -along / power)


def _at_its_size(base: Baseline, secant: Signature) -> Signature:
    """Evaluate an effect at the size that its secant gives, or, where that does not hold, at the best of a scan.

    The error of a gap or a delay has a narrow valley that no slope shows from outside. A secant that promises nothing worth a fit
    is taken at its word: starts are tried until their change is in proportion to the errors, so that a valley would show.
    """
    numbers, factors = base.numbers, _factors(base, secant)
    if factors == (1.0,) or secant.explained == 0.0:
        return _at_size(base, secant, 1.0)
    found = [_unscaled(secant)]
    if secant.factor > 0.0 or min(factors) < 0.0:
        largest = numbers.largest_factor
        found.append(_at_size(base, secant, float(np.clip(secant.factor, -largest, largest))))
        if found[-1].explained > numbers.linear * secant.explained:
            return found[-1]
    if secant.explained > numbers.least_explained:
        found += [_at_size(base, secant, factor) for factor in factors]
    return max(found, key=lambda s: s.explained)


def _unscaled(secant: Signature) -> Signature:
    """Evaluate an effect at the size of its secant: the parabola along it, at 1."""
    factor = secant.factor
    return Signature(secant.effect, secant.start, secant.explained * (2.0 * factor - 1.0) / factor**2)


def _factors(base: Baseline, signature: Signature) -> tuple[float, ...]:
    """List the factors of an effect's size to scan: of both signs where it has two, one where it cannot be scaled."""
    effect, sizes = base.arm.known[signature.effect], base.numbers.sizes
    if not effect.fitted:
        return (1.0,)
    return (*sizes, *(-size for size in sizes)) if has_two_signs(effect) else sizes


def _at_size(base: Baseline, signature: Signature, factor: float) -> Signature:
    values = sized(base.arm, signature.effect, signature.start, factor, base.objective.dataset)
    left = base.square_unexplained(base.residual_with(signature.effect, values))
    return Signature(signature.effect, values, 1.0 - left / base.left_square)
