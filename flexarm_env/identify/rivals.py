"""Which of the effects that look alike it is: they change places where one fits better beside everything else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from flexarm_env.arm import Arm
from flexarm_env.identify.acceptance import LEAST_GAIN, Acceptance
from flexarm_env.identify.data import Data
from flexarm_env.identify.fits import Fits
from flexarm_env.identify.hypothesis import Hypothesis, at_bound, criterion, judged
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.problem import Score
from flexarm_env.identify.refit import FAR_OFF, NEAR, polish
from flexarm_env.identify.screen import candidates

#: Two effects are equivalent if the excess error that they leave differs by less than the first share of what they remove, and
#: by less than one of them leaves, or the second, whichever is more.
SAME_GAIN, SAME_EXCESS = 0.03, 0.1


@dataclass(frozen=True)
class Place:
    """What may stand where an effect stands.

    Attributes:
        effect: the one that fits best there.
        best: the hypothesis with it beside everything else.
        alike: the hypotheses with others that leave as little, by effect.
        tried: all effects that were held against each other.
    """

    effect: str
    best: Hypothesis
    alike: dict[str, Hypothesis]
    tried: frozenset[str]


def order_of(best: Score, data: Data, measure: Callable[[Score], float]) -> Callable[[Hypothesis], float]:
    """Return what rivals are ordered by: all of the data where the best comes near the noise, else what was held out."""
    return (lambda h: criterion(h, data)) if best.windows < NEAR[1] else (lambda h: measure(h.score))


def same(removed: float, left: float) -> float:
    """Return by how much the excess errors that equivalent effects leave differ at most."""
    return min(SAME_GAIN * removed, max(left, SAME_EXCESS))


def rivals_of(effect: str, without: Arm) -> list[str]:
    """Return the effects that an effect is confused with, which an arm without it lacks.

    There are none for what another effect of the arm changes, and could not stand without.
    """
    known = without.known
    if any(known[n].modifies == effect for n in without.effects):
        return []
    return [n for n in candidates(without) if n in known[effect].confused_with or effect in known[n].confused_with]


def in_place_of(effect: str, now: Hypothesis, fits: Fits, rules: Acceptance, done: float) -> Place:
    """Return what fits best where an effect is now, and what leaves as little there.

    Args:
        effect: one of those of the hypothesis.
        now: with everything that was found.
        fits: of rivals.
        rules: of acceptance.
        done: share of the search.
    """
    without = now.refit.arm.without_effect(effect)
    found = [h for h in fits.instead(without, rivals_of(effect, without), done) if not at_bound(h)]
    if not found:
        return Place(effect, now, {}, frozenset([effect]))
    measure = rules.measure_of([now.score, *(h.score for h in found)])
    order = order_of(now.score, fits.data, measure)
    found.sort(key=order)
    if now.score.windows > NEAR[1] or found[0].score.windows < FAR_OFF:  # what is far off comes nowhere near what is near
        with in_threads(fits.jobs):
            polished = judged(found[0].effects, polish(found[0].refit, fits.nominal, fits.data), fits.data)
        found[0] = found[0] if at_bound(polished) else polished
    least = LEAST_GAIN if now.score.windows >= NEAR[1] else 0.0
    better = order(found[0]) < (1.0 - least) * order(now)
    if at_bound(replace(now, effects=(effect,))):  # no size of it explains the data
        better = better or measure(found[0].score) <= _level(now.score, rules, measure)
    every = {effect: now} | {h.effects[0]: h for h in found}
    taken = found[0].effects[0] if better else effect
    level = _level(every[taken].score, rules, measure)
    alike = {name: h for name, h in every.items() if name != taken and measure(h.score) <= level}
    return Place(taken, every[taken], alike, frozenset(every))


def _level(best: Score, rules: Acceptance, measure: Callable[[Score], float]) -> float:
    """Return the most that equivalent effects leave."""
    left = measure(best)
    return left + same(measure(rules.first) - left, left)
