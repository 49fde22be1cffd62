"""Effects added one by one, however little each gains alone: where two are missing, neither may stand out."""

from __future__ import annotations

from collections.abc import Sequence

from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.select.criteria import Criteria
from flexarm_env.identify.select.model import Model, judge
from flexarm_env.identify.select.screen import screen


def extend_chain(calibrator: Calibrator, criteria: Criteria, chain: Sequence[Model], progress: Progress) -> tuple[Model, ...]:
    """Extend a chain of models, each of one more effect, until one is fully explained or no effect fits better than none.

    Each step takes the effect that fits best beside the others, as stepwise regression does. Some effects also imitate
    physics outside the catalogue, but not down to the noise.

    Args:
        calibrator: of the recordings.
        criteria: of the search.
        chain: to be extended; its first model has no effect.
        progress: of this extension.

    Returns:
        The chain; empty where it cannot be extended to a model that is fully explained, or not in time.
    """
    models = list(chain)
    while len(models) <= calibrator.settings.selecting.most_effects and not calibrator.workers.deadline.is_over:
        last = models[-1]
        step = _best_addition(calibrator, last, progress)
        if step is None:
            return tuple(models)
        models.append(Model((*last.effects, *step.effects), step.calibration, step.score, step.fitted_score))
        if step.at_bound:
            break
        if criteria.is_fully_explained(models[-1]):
            return tuple(models)
        if last.effects and not criteria.is_worthwhile(last, models[-1], lambda s: s.excess):
            break
    return ()


def _best_addition(calibrator: Calibrator, last: Model, progress: Progress) -> Model | None:
    """Calibrate with the effect that fits best beside those of a model, as far as it goes where it comes near."""
    trials = screen(calibrator, [last.calibration], progress).trials
    best = min(trials, key=lambda trial: trial.cost)
    if not best.effect:
        return None
    errors, dataset = calibrator.settings.errors, calibrator.dataset
    with calibrator.workers.threads():
        step = judge((best.effect,), calibrator.calibrate(best.arm), dataset)
        if errors.near < step.score.windows < errors.close:
            step = judge((best.effect,), calibrator.polish(step.calibration), dataset)
    return step
