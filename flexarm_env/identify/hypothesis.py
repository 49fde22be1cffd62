"""A hypothesis: effects tried together, how they are fitted, and by what excess error they are judged."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from flexarm_env.arm import Arm
from flexarm_env.identify.data import Data
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.refit import FAR_OFF, NEAR, Refit, as_it_is, or_from_nominal, refit
from flexarm_env.identify.screen import Base, Trial, attempt, first_start, screening_base, signatures

#: A brief fit is one at this level, of so many iterations.
BRIEF_LEVEL, BRIEF_ITERATIONS = 0.003, 2


def excess(value: float) -> float:
    """Return the excess of an error over the noise, as a variance."""
    return max(value**2 - 1.0, 1e-9)


@dataclass
class Hypothesis:
    """Effects tried together, the arm refitted with them, and its errors on the held-out part and on the fitted one."""

    effects: tuple[str, ...]
    refit: Refit
    score: Score
    fitted: Score


def judged(effects: tuple[str, ...], found: Refit, data: Data) -> Hypothesis:
    """Return the hypothesis that a refitted arm is."""
    return Hypothesis(effects, found, score(found.arm, data), score(found.arm, data, held_out=False))


def criterion(hypothesis: Hypothesis, data: Data) -> float:
    """Return the Bayesian information criterion of a hypothesis near the noise, on all of the data (Schwarz, Ann. Stat. 6, 461).

    The held-out part alone tells whether an effect is missing; which of two rivals it is, more samples tell better.
    """
    fitted = sum(int(run.train.sum()) for run in data.runs) * len(data.signals)
    held = sum(len(run.train) for run in data.runs) * len(data.signals) - fitted
    errors = fitted * hypothesis.fitted.windows**2 + held * hypothesis.score.windows**2
    return errors + len(hypothesis.refit.coordinates) * math.log(fitted + held)


def in_windows(score: Score) -> float:
    """Return the excess error in windows."""
    return excess(score.windows)


def measure_of(scores: Sequence[Score]) -> Callable[[Score], float]:
    """Return the excess error by which hypotheses are judged: in windows where one comes near the noise.

    Else what holds for long counts as much, which the whole run shows; and alone, where even one second is far off.
    """
    best = min(s.windows for s in scores)
    if best > FAR_OFF:
        return lambda s: excess(s.free_run)
    if best > NEAR[1]:
        return lambda s: math.sqrt(excess(s.windows) * excess(s.free_run))
    return in_windows


def try_effect(base: Base, name: str) -> list[Trial]:
    """Return an effect fitted from its most promising start, if it explains anything."""
    return [attempt(base, signature) for signature in signatures(base, name)]


def fit_hypothesis(effects: tuple[str, ...], arm: Arm, nominal: Arm, data: Data, thorough: bool) -> Hypothesis:
    """Return an arm refitted with effects; if thorough, from the nominal constants as well."""
    found = refit(arm, nominal, data)
    if thorough:
        found = or_from_nominal(found, nominal, data)
    return judged(effects, found, data)


def fit_from_signature(effect: str, without: Arm, nominal: Arm, data: Data) -> Hypothesis:
    """Return an arm refitted with an effect, started where it explains most of what the arm leaves."""
    found = signatures(screening_base(as_it_is(without, data), data), effect)
    start = found[0].start if found else first_start(without, effect, data.scales)
    return fit_hypothesis((effect,), without.with_effect(effect, **start), nominal, data, thorough=False)


def asks_for_offset(found: Refit, data: Data) -> float:
    """Return the share of what a refit leaves that looks like a constant torque."""
    return sum(signature.explained for signature in signatures(screening_base(found, data), found.arm.known.pairing))


def fit_briefly(arm: Arm, nominal: Arm, data: Data) -> tuple[float, Refit]:
    """Return an arm fitted in a few steps, and its error on the fitted part."""
    found = refit(arm, nominal, data, (BRIEF_LEVEL,), BRIEF_ITERATIONS, passes=0)
    return score(found.arm, data, held_out=False).windows, found


def at_bound(hypothesis: Hypothesis) -> bool:
    """Whether a parameter of its effects ran to the end of its range: no size of the effect explains the data."""
    arm = hypothesis.refit.arm
    for c in hypothesis.refit.coordinates:
        section, name, *_ = c.path.split(".")
        value = arm.value(c.path)
        if section == "effects" and name in hypothesis.effects and value in (c.low, c.high):
            return True
    return False
