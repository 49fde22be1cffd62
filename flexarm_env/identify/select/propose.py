"""Models of one more effect: which candidates are calibrated in full, and from which constants, until one comes near."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.select.criteria import Criteria
from flexarm_env.identify.select.fits import fit_models, fit_rivals, fit_with_all_constants, fit_with_companion
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.select.screen import Trial, control_of, screen

#: Calibrates arms with the effects that they were given.
Fit = Callable[[Calibrator, Sequence[tuple[str, ...]], Sequence[Arm], Progress], list[Model]]


def starts_of_search(calibrator: Calibrator, criteria: Criteria, found: Model) -> list[Calibration]:
    """Choose the constants from which candidates are screened: the calibrated ones, and the nominal ones where those did little.

    Constants that cannot explain the data are biased, and an effect tried from there fails.
    """
    if found.effects or criteria.trusts_constants():
        return [found.calibration]
    nominal = calibrator.uncalibrated(calibrator.nominal)
    return [nominal] if criteria.rejects_constants() else [found.calibration, nominal]


def nearest(calibrator: Calibrator, criteria: Criteria, trials: Sequence[Trial], progress: Progress) -> list[Model]:
    """Calibrate the candidates that lower the cost of the screening most, and the next best if none of them is sufficient."""
    numbers, control = calibrator.settings.proposing, control_of(trials).cost
    lowest = min(t.cost for t in trials)
    level = min(numbers.least_change * control, control - numbers.least_of_best * (control - lowest))
    near = control - numbers.near_best * (control - lowest)
    better = [t for t in trials if t.effect and t.cost < level][: numbers.finalists]
    best, rest = better[:1], better[1:]
    models = _fitted(fit_models, calibrator, best, progress)
    if any(criteria.is_sufficient(m) for m in models):
        return models + _fitted(fit_rivals, calibrator, [t for t in rest if t.cost <= near], progress)
    for part in ([t for t in rest if t.cost <= near], [t for t in rest if t.cost > near]):
        if not any(criteria.is_sufficient(m) for m in models):
            models += _fitted(fit_models, calibrator, part, progress)
    return models


def _fitted(fit: Fit, calibrator: Calibrator, trials: Sequence[Trial], progress: Progress) -> list[Model]:
    return fit(calibrator, [(t.effect,) for t in trials], [t.arm for t in trials], progress)


def others(
    calibrator: Calibrator, criteria: Criteria, models: list[Model], trials: Sequence[Trial], found: Model, progress: Progress
) -> list[Model]:
    """Add models from unbiased constants where none comes near.

    Args:
        calibrator: of the recordings.
        criteria: of the search.
        models: calibrated with the candidates that promise most.
        trials: of every effect.
        found: the model that the effect is sought for.
        progress: of this search.
    """
    screening, nearer, constants, companions = progress.split(1, 1, 1, 2)
    is_first = not found.effects
    if none_comes_near(criteria, models, found) and not (is_first and not criteria.trusts_constants()):
        unbiased = calibrator.uncalibrated(calibrator.nominal_with_effects_of(found.arm))
        again = nearest(calibrator, criteria, screen(calibrator, [unbiased], screening).trials, nearer)
        models = _best_of_each(criteria, [*models, *again])
    if none_comes_near(criteria, models, found) and is_first:  # a second effect's fits take minutes
        tried = [m.effects[0] for m in models]
        models = models + fit_with_all_constants(calibrator, found.calibration, trials, tried, constants)
    companion = found.arm.known.pairing
    lacks_companion = bool(companion) and companion not in found.arm.effects
    if lacks_companion and models and not any(criteria.is_sufficient(m) for m in models):
        models = models + fit_with_companion(calibrator, models, companions)
    return models


def none_comes_near(criteria: Criteria, models: Sequence[Model], without: Model) -> bool:
    """Whether all models are inadequate."""
    return criteria.is_inadequate(min((m.score.windows for m in models), default=np.inf), without)


def _best_of_each(criteria: Criteria, models: Sequence[Model]) -> list[Model]:
    """Keep the best model of each set of effects."""
    if not models:
        return []
    measure = criteria.measure([m.score for m in models])
    best = {m.effects: m for m in sorted(models, key=lambda m: -measure(m.score))}
    return list(best.values())
