"""Effects added one by one, whatever each of them gains alone: where two are missing, neither may stand out."""

from __future__ import annotations

from collections.abc import Sequence

from flexarm_env.identify.acceptance import Acceptance
from flexarm_env.identify.fits import Fits
from flexarm_env.identify.hypothesis import Hypothesis, at_bound, in_windows, judged
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.refit import NEAR, Refit, polish, refit


def one_by_one(
    chain: Sequence[Hypothesis], fits: Fits, rules: Acceptance, most: int, done: float, bent: bool
) -> list[Hypothesis]:
    """Return a chain of hypotheses of one more effect each until one is whole, or until no effect fits better than none.

    Each step takes what fits best beside what is there already, as stepwise regression does. What no catalogue holds is imitated
    by some effects, too, but not to the noise.

    Args:
        chain: to be gone on with; its first hypothesis has no effect.
        fits: of effects beside what was found.
        rules: of acceptance.
        most: effects in the end.
        done: share of the search.
        bent: whether, where no effect helps, each is fitted with all constants, which may have made up for it.

    Returns:
        The chain, or nothing where the effects of one do not make a whole.
    """
    steps = list(chain)
    while len(steps) <= most:
        last = steps[-1]
        step = _step(last.refit, fits, done, bent)
        if step is None:
            return steps
        steps.append(Hypothesis((*last.effects, *step.effects), step.refit, step.score, step.fitted))
        if at_bound(step):
            break
        if rules.is_whole(step.score):
            return steps
        if last.effects and not rules.is_worth(last.score, step.score, in_windows):
            break
    return []


def _step(found: Refit, fits: Fits, done: float, bent: bool) -> Hypothesis | None:
    """Return the arm refitted with the effect that fits best beside what was found, as far as it goes where it comes near."""
    trials = fits.screen([found], done, 0.0)
    best = min(trials, key=lambda trial: trial.cost)
    if not best.effect:
        others = fits.with_all_constants(found, trials, (), done, 0.0) if bent else []
        return min(others, key=lambda h: h.fitted.windows, default=None)
    with in_threads(fits.jobs):
        step = judged((best.effect,), refit(best.arm, fits.nominal, fits.data), fits.data)
        if NEAR[0] < step.score.windows < NEAR[1]:
            step = judged((best.effect,), polish(step.refit, fits.nominal, fits.data), fits.data)
    return step
