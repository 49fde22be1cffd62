"""What others do, on the same plant and the same fits: best fit wins, and stepwise by the Bayesian information criterion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from flexarm_env import Arm, Recording
from flexarm_env.identify.data import Data, prepare
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.refit import Refit, best_refit, refit
from flexarm_env.identify.screen import attempt, best_trials, candidates, screening_base, signatures

MOST_EFFECTS = 3


def best_fit_wins(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Take the effect that fits best, always (the ladder of models of Rhoban's BAM: Duclusaud et al., arXiv 2410.08650)."""
    nominal, data = prepare(arm, recordings)
    base = best_refit(nominal, data)
    found = _best(base, nominal, data)
    effects = [] if found is None else [found[0]]
    return answer(effects, nominal, base, base if found is None else found[1], data)


def stepwise_bic(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Add the effect that fits best while the Bayesian information criterion falls (Schwarz, Ann. Stat. 6 (1978) 461)."""
    nominal, data = prepare(arm, recordings)
    base = found = best_refit(nominal, data)
    effects: list[str] = []
    while len(effects) < MOST_EFFECTS:
        step = _best(found, nominal, data)
        if step is None or _criterion(step[1], data) >= _criterion(found, data):
            break
        effects.append(step[0])
        found = step[1]
    return answer(effects, nominal, base, found, data)


def _best(found: Refit, nominal: Arm, data: Data) -> tuple[str, Refit] | None:
    """Return the effect whose addition fits the recordings best, and the arm refitted with it."""
    base = screening_base(found, data)
    trials = [attempt(base, s) for name in candidates(found.arm) for s in signatures(base, name)]
    if not trials:
        return None
    best = min(best_trials(trials), key=lambda trial: trial.cost)
    return best.effect, refit(best.arm, nominal, data)


def _criterion(found: Refit, data: Data) -> float:
    """Return BIC: the sum of squares of the errors in windows over the noise, and what the parameters cost."""
    count = sum(int(run.train.sum()) for run in data.runs) * len(data.signals)
    return count * score(found.arm, data, held_out=False).windows ** 2 + len(found.coordinates) * math.log(count)


def answer(effects: list[str], nominal: Arm, base: Refit, found: Refit, data: Data) -> dict[str, Any]:
    """Return what a method found, in the form of a diagnosis."""
    before, first, last = (score(arm, data) for arm in (nominal, base.arm, found.arm))
    verdict = "effects" if effects else "parameters"
    return {
        "verdict": verdict,
        "effects": effects,
        "equivalent": [[name] for name in effects],
        "ranking": [{"effect": name, "gain": 1.0, "accepted": True, "parameters": {}} for name in effects],
        "error": _errors(before, first, last),
        "constants": {},
    }


def _errors(before: Score, first: Score, last: Score) -> dict[str, float]:
    return {"nominal": before.windows, "refitted": first.windows, "final": last.windows}
