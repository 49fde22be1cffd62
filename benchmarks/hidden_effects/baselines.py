"""Baselines on the same plant and the same fits: best fit, and stepwise selection by the Bayesian information criterion."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

from flexarm_env import Arm, Recording
from flexarm_env.identify.data import Data, prepare
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.refit import Refit, best_refit, refit
from flexarm_env.identify.screen import attempt, best_trials, candidates, screening_base, signatures

MOST_EFFECTS = 3


def stepwise(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Add the best-fitting effect while the Bayesian information criterion falls (Schwarz, Ann. Stat. 6 (1978) 461).

    "first_step" holds the answer of `best_fit_wins`, which is the first step, with the core seconds spent after it.
    """
    nominal, data = prepare(arm, recordings)
    base = found = best_refit(nominal, data)
    effects: list[str] = []
    first: dict[str, Any] = {}
    stepped = 0.0
    while len(effects) < MOST_EFFECTS:
        step = _best(found, nominal, data)
        if not first:
            after = (found, []) if step is None else (step[1], [step[0]])
            first, stepped = answer(after[1], nominal, base, after[0], data), time.process_time()
        if step is None or _criterion(step[1], data) >= _criterion(found, data):
            break
        effects.append(step[0])
        found = step[1]
    later = time.process_time() - stepped
    return answer(effects, nominal, base, found, data) | {"first_step": {"found": first, "later_seconds": later}}


def best_fit_wins(stepped: dict[str, Any]) -> dict[str, Any]:
    """Take the best-fitting effect, always (the ladder of models of Rhoban's BAM: Duclusaud et al., arXiv 2410.08650).

    Args:
        stepped: the benchmark's answer by `stepwise`.
    """
    first: dict[str, Any] = stepped["found"]["first_step"]
    return stepped | {"found": first["found"], "cpu_seconds": stepped["cpu_seconds"] - first["later_seconds"]}


def _best(found: Refit, nominal: Arm, data: Data) -> tuple[str, Refit] | None:
    """Find the effect with the best fit when added, and the arm refitted with it."""
    base = screening_base(found, data)
    trials = [attempt(base, s) for name in candidates(found.arm) for s in signatures(base, name)]
    if not trials:
        return None
    best = min(best_trials(trials), key=lambda trial: trial.cost)
    return best.effect, refit(best.arm, nominal, data)


def _criterion(found: Refit, data: Data) -> float:
    """Compute BIC: the sum of squared errors in windows over the noise, plus the penalty on parameters."""
    count = sum(int(run.train.sum()) for run in data.runs) * len(data.signals)
    return count * score(found.arm, data, held_out=False).windows ** 2 + len(found.coordinates) * math.log(count)


def answer(effects: list[str], nominal: Arm, base: Refit, found: Refit, data: Data) -> dict[str, Any]:
    """Convert a method's result to the form of a diagnosis."""
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
