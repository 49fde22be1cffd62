"""Choose among models of one more effect: the best one, and the simplest of those that are as good."""

from __future__ import annotations

from collections.abc import Sequence

from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.criteria import Criteria, Measure
from flexarm_env.identify.select.model import Model


def best_of(criteria: Criteria, models: Sequence[Model]) -> Model | None:
    """Find the best of the models whose effects stay within their ranges; None without any."""
    possible = [m for m in models if not m.at_bound]
    if not possible:
        return None
    measure = criteria.measure([m.score for m in possible])
    return min(possible, key=lambda m: measure(m.score))


def with_forecasts(calibrator: Calibrator, criteria: Criteria, models: Sequence[Model], best: Score) -> list[Model]:
    """Fit the forecasts of models in processes, where the score of the best one calls for a ranking by them."""
    if not criteria.ranks_by_forecasts(best):
        return list(models)
    return list(calibrator.workers.map([(_with_forecast, (model,)) for model in models]))


def _with_forecast(model: Model) -> Model:
    """Fit the forecasts of a model, which then keeps their cost."""
    _ = model.forecast_cost
    return model


def comes_near(criteria: Criteria, before: Model, model: Model, winner: Model, measure: Measure) -> bool:
    """Whether a model removes nearly as much of the error as the best one."""
    removed, most = (measure(before.score) - measure(m.score) for m in (model, winner))
    return criteria.comes_near(removed, most)


def removes_enough(criteria: Criteria, without: Model, found: Model, measure: Measure) -> bool:
    """Whether more effects remove enough by a measure, or in windows: off the noise, one may rest where it should move."""
    measures: tuple[Measure, ...] = (measure, lambda s: s.excess)
    return any(criteria.is_worthwhile(without, found, by) for by in measures)


def simplest(calibrator: Calibrator, criteria: Criteria, models: Sequence[Model], before: Model, measure: Measure) -> Model:
    """Choose the best model; a single effect where no companion of nearly the best adds anything worthwhile.

    Where whole runs say little, forecasts choose among those that remove enough: a run ends where a hub happened to stick, and a
    flexible enough effect imitates that.

    Args:
        calibrator: of the recordings.
        criteria: of the search.
        models: of one more effect, or of two, than the one before; at least one.
        before: the model to which they add.
        measure: of the error.
    """
    best = min(models, key=lambda m: measure(m.score))
    by_forecasts = criteria.ranks_by_forecasts(best.score)
    if by_forecasts:
        near = [m for m in models if removes_enough(criteria, before, m, measure)] or [best]
        models = sorted(near, key=lambda m: m.forecast_cost)
    singles, pairs = ([m for m in models if (len(m.effects) == 1) == single] for single in (True, False))
    if not singles:
        return models[0]
    if by_forecasts:
        better = [
            m for m in pairs if m.forecast_cost < singles[0].forecast_cost - calibrator.settings.forecast_searching.least_log_gain
        ]
    else:
        level = criteria.equivalence_level(models[0].score, measure)
        better = [m for m in pairs if measure(m.score) <= level]
    chosen = [m for m in better if removes_enough(criteria, singles[0], m, measure)]
    return chosen[0] if chosen else singles[0]
