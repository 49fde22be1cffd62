"""Baselines on the same plant and the same fits: best fit, and stepwise selection by the Bayesian information criterion."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

from flexarm_env import Arm, Recording
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.screen import try_effect
from flexarm_env.identify.select.signatures import baseline
from flexarm_env.identify.select.starts import candidates

MOST_EFFECTS = 3


def stepwise(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Add the best-fitting effect while the Bayesian information criterion falls (Schwarz, Ann. Stat. 6 (1978) 461).

    "first_step" holds the answer of `best_fit_wins`, which is the first step, with the core seconds spent after it.
    """
    calibrator = Calibrator(*prepare(arm, recordings))
    base = found = calibrator.calibrate_constants()
    effects: list[str] = []
    first: dict[str, Any] = {}
    stepped = 0.0
    while len(effects) < MOST_EFFECTS:
        step = _best(calibrator, found)
        if not first:
            after = (found, []) if step is None else (step[1], [step[0]])
            first, stepped = answer(after[1], calibrator, base, after[0]), time.process_time()
        if step is None or _criterion(calibrator, step[1]) >= _criterion(calibrator, found):
            break
        effects.append(step[0])
        found = step[1]
    later = time.process_time() - stepped
    return answer(effects, calibrator, base, found) | {"first_step": {"found": first, "later_seconds": later}}


def best_fit_wins(stepped: dict[str, Any]) -> dict[str, Any]:
    """Take the best-fitting effect, always (the ladder of models of Rhoban's BAM: Duclusaud et al., arXiv 2410.08650).

    Args:
        stepped: the benchmark's answer by `stepwise`.
    """
    first: dict[str, Any] = stepped["found"]["first_step"]
    return stepped | {"found": first["found"], "cpu_seconds": stepped["cpu_seconds"] - first["later_seconds"]}


def _best(calibrator: Calibrator, found: Calibration) -> tuple[str, Calibration] | None:
    """Find the effect with the best fit when added, and the arm refitted with it."""
    base = baseline(found, calibrator.dataset)
    trials = [trial for name in candidates(found.arm, calibrator.dataset) for trial in try_effect([base], name)]
    if not trials:
        return None
    best = min(trials, key=lambda trial: trial.cost)
    return best.effect, calibrator.calibrate(best.arm)


def _criterion(calibrator: Calibrator, found: Calibration) -> float:
    """Compute BIC: the sum of squared errors in windows over the noise, plus the penalty on parameters."""
    data = calibrator.dataset
    count = data.readings(held_out=False)
    return count * calibrator.score(found.arm, held_out=False).windows ** 2 + len(found.parameters) * math.log(count)


def answer(effects: list[str], calibrator: Calibrator, base: Calibration, found: Calibration) -> dict[str, Any]:
    """Convert a method's result to the form of a diagnosis."""
    errors = [calibrator.score(arm).windows for arm in (calibrator.nominal, base.arm, found.arm)]
    verdict = "effects" if effects else "parameters"
    return {
        "verdict": verdict,
        "effects": effects,
        "equivalent": [[name] for name in effects],
        "ranking": [{"effect": name, "gain": 1.0, "accepted": True, "parameters": {}} for name in effects],
        "error": dict(zip(("nominal", "refitted", "final"), errors, strict=True)),
        "constants": {},
    }
