"""Models between which the data do not decide: each is calibrated anew before one is named."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.select.criteria import Criteria, Measure
from flexarm_env.identify.select.fits import fit_models
from flexarm_env.identify.select.model import Model


@dataclass(frozen=True)
class Rivals:
    """Models between which the data do not decide.

    Attributes:
        models: the one to name first.
        measure: of the error by which they were compared.
        tried: every near model as it was calibrated at last, best or not; empty where nothing came near the winner.
        is_complete: whether the time sufficed to calibrate each of them again.
    """

    models: tuple[Model, ...]
    measure: Measure
    tried: tuple[Model, ...] = ()
    is_complete: bool = True


def find_rivals(
    calibrator: Calibrator, criteria: Criteria, before: Model, winner: Model, models: Sequence[Model], measure: Measure
) -> Rivals:
    """Find the models between which the data do not decide, each calibrated from nominal constants, too.

    A calibration that began with biased constants leaves more than the difference between near rivals, and so does one that
    ended where constants compensate each other: each is calibrated by both schedules, and ranked by what it then leaves.
    A winner that leaves only noise needs none of that beside rivals of more numbers: none can stand before it. Where no time is
    left for another calibration, all near rivals are taken as undecided. Where whole runs say little, rivals are those whose
    forecasts are as likely.

    Args:
        calibrator: of the recordings.
        criteria: by which models are judged.
        before: the model to which each adds an effect.
        winner: the best of them.
        models: of as many effects, the winner among them.
        measure: of the error.
    """
    if criteria.ranks_by_forecasts(winner.score):
        most = winner.forecast_cost + calibrator.settings.forecast_searching.least_log_gain
        rest = sorted([m for m in models if m is not winner], key=lambda m: measure(m.score))
        return Rivals((winner, *(m for m in rest if m.forecast_cost <= most)), measure)
    left = measure(winner.score)
    most = left + criteria.contender_difference(measure(before.score) - left)
    first = [m for m in models if m is winner or measure(m.score) <= most]
    if len(first) == 1:
        return Rivals((winner,), measure)
    if not criteria.leaves_room(winner) and all(m is winner or m.numbers > winner.numbers for m in first):
        level = criteria.equivalence_level(winner.score, measure)
        equals = [m for m in first if m is not winner and measure(m.score) <= level]
        return Rivals((winner, *sorted(equals, key=lambda m: measure(m.score))), measure)
    arms = [calibrator.nominal_with_effects_of(m.arm) for m in first]
    again = fit_models(calibrator, [m.effects for m in first], arms, Progress(), thorough=True)
    if len(again) < len(first):
        ranked = sorted(first, key=criteria.rank(winner.score, measure, calibrator.dataset))
        return Rivals(tuple(ranked), measure, is_complete=False)
    every = (*first, *again)
    measure = criteria.measure([m.score for m in every])
    least = min((m.score for m in every), key=measure)
    removed, rank = measure(before.score) - measure(least), criteria.rank(least, measure, calibrator.dataset)
    better = [min(pair, key=rank) for pair in zip(first, again, strict=True)]
    left = min(measure(m.score) for m in better)
    most = left + criteria.equivalent_difference(removed, left)
    ranked = sorted([m for m in better if measure(m.score) <= most], key=rank)
    best = next(pair for pair in zip(first, again, strict=True) if ranked[0] in pair)
    errors = calibrator.settings.errors
    simplest = _simplest(ranked, max(errors.converged, spread(*best)), errors.same)
    return Rivals((simplest, *(m for m in ranked if m is not simplest)), measure, tuple(better))


def spread(one: Model, other: Model) -> float:
    """Compute the ratio of the errors of two calibrations of one model, the larger one over the smaller one.

    Where errors are rough, calibrations end in different minima. Models whose errors differ by less are equally good.
    """
    return max(one.error_over(other), other.error_over(one))


def is_simpler_and_as_good(model: Model, other: Model, most: float, same: float) -> bool:
    """Whether a model has fewer numbers than another, or as many and laws of fewer quantities, and an error that is no larger.

    Args:
        model: the one in question.
        other: to which it is compared.
        most: ratio of the errors up to which fewer numbers are as good.
        same: ratio up to which two models move alike, so that nothing but their laws tells them apart.
    """
    if model.numbers == other.numbers:
        return model.quantities < other.quantities and model.error_over(other) <= same
    return model.numbers < other.numbers and model.error_over(other) <= most


def _simplest(ranked: Sequence[Model], most: float, same: float) -> Model:
    """Choose the simplest of the models that are as good as the first one."""
    every = [ranked[0], *(m for m in ranked if is_simpler_and_as_good(m, ranked[0], most, same))]
    return min(every, key=lambda m: (m.numbers, m.quantities))
