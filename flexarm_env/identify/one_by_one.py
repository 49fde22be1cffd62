"""Effects added one by one, whatever each of them gains alone: where two are missing, neither may stand out."""

from __future__ import annotations

from flexarm_env.identify.acceptance import PERFECT, Acceptance
from flexarm_env.identify.fits import Fits
from flexarm_env.identify.hypothesis import Hypothesis, at_bound, judged
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.refit import Refit, refit


def one_by_one(base: Refit, fits: Fits, rules: Acceptance, most: int, done: float) -> list[Hypothesis]:
    """Return the hypotheses of one effect, two, …, of which the last leaves no more than noise; none where none does.

    Each step takes what fits best beside what is there already, as stepwise regression does. What no catalogue holds is imitated
    by some effects, too, but not to the noise.

    Args:
        base: the refitted constants.
        fits: of effects beside what was found.
        rules: of acceptance.
        most: effects that are tried.
        done: share of the search.
    """
    steps: list[Hypothesis] = []
    while len(steps) < most:
        step = _best(steps[-1].refit if steps else base, fits, bool(steps), done)
        if step is None or at_bound(step):
            break
        steps.append(Hypothesis((*(h.effects[-1] for h in steps), *step.effects), step.refit, step.score, step.fitted))
        if step.score.windows < PERFECT and rules.explains(step.score):
            return steps
    return []


def _best(found: Refit, fits: Fits, bent: bool, done: float) -> Hypothesis | None:
    """Return the arm refitted with the effect that fits best beside what was found.

    Args:
        found: the arm so far.
        fits: of effects beside it.
        bent: whether every effect is fitted with all constants where none helps: they may have made up for it.
        done: share of the search.
    """
    trials = fits.screen([found], done, 0.0)
    best = min(trials, key=lambda trial: trial.cost)
    if best.effect:
        with in_threads(fits.jobs):
            return judged((best.effect,), refit(best.arm, fits.nominal, fits.data), fits.data)
    others = fits.with_all_constants(found, trials, (), done, 0.0) if bent else []
    return min(others, key=lambda h: h.fitted.windows, default=None)
