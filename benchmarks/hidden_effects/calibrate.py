"""Find the size of each effect at which a model with refitted constants has a given error over the noise."""

from __future__ import annotations

import fnmatch
import json
import math
from collections.abc import Callable

from benchmarks.hidden_effects.cases import EXPERIMENTS, SIZES, STRENGTHS, Case, in_commands, sizes
from benchmarks.hidden_effects.effects import CATALOGUE, OUTSIDE, Hidden
from flexarm_env import Arm
from flexarm_env.files import write_whole
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score
from flexarm_env.identify.workers import Workers

#: Relative tolerance of a strength, largest number of trials, and largest accepted deviation (a logarithm).
NEAR, TRIALS, MISSED = 0.15, 5, 0.35
#: Weakening of the first size tried against the strongest, and of the last (logarithms).
FIRST, LAST = 1.5, 8.0
LEAST = 0.05


def strength_at(hidden: Hidden, size: float) -> float:
    """Compute the excess error over the noise after a refit of the constants, which are right before it."""
    middle = {key: 0.5 * (low + high) if low > -1.0 else 0.3 * high for key, (low, high) in hidden.others.items()}
    settings = in_commands(hidden, {hidden.setting: size, **middle}, EXPERIMENTS[0], seed=1)
    case = Case("", "one", (), 0.0, settings, EXPERIMENTS[0], seed=1)
    arm, data = prepare(Arm.load("thesis-fem"), case.recordings())
    found = Calibrator(arm, data).calibrate(arm)
    error = min(score(found.arm, data).windows, score(arm, data).windows)
    return math.sqrt(max(error**2 - 1.0, 0.0))


def find(effect: str, hidden: Hidden) -> tuple[str, dict[str, float]]:
    """Find the effect's size by strength, without strengths beyond any plausible size; return its name first."""
    known: list[tuple[float, float]] = []  # logarithms of the weakening from the strongest and of the strength

    def size(weaker: float) -> float:
        return hidden.strongest * math.exp(weaker if hidden.inverse else -weaker)

    def measured(weaker: float) -> float:
        strength = strength_at(hidden, size(weaker))
        known.append((weaker, math.log(max(strength, LEAST))))
        return strength

    out = {}
    for strength in STRENGTHS[::-1]:
        for _ in range(TRIALS):
            weaker = _next(known, math.log(strength))
            if weaker is None or abs(measured(weaker) - strength) < NEAR * strength:
                break
        nearest = min(known, key=lambda pair: abs(pair[1] - math.log(strength)))
        if abs(nearest[1] - math.log(strength)) < MISSED:
            out[f"{strength:g}"] = float(f"{size(nearest[0]):.3g}")
    return effect, dict(sorted(out.items(), key=lambda item: float(item[0])))


def _next(known: list[tuple[float, float]], wanted: float) -> float | None:
    """Choose the next trial: interpolate between neighbours, else extrapolate a line; None past either end."""
    if not known:
        return FIRST
    above = max((k for k in known if k[1] >= wanted), default=None)
    below = min((k for k in known if k[1] < wanted), default=None)
    if above and below:
        share = (above[1] - wanted) / (above[1] - below[1])
        return above[0] + min(max(share, 0.1), 0.9) * (below[0] - above[0])
    near = above or below
    assert near is not None
    there = min(max(near[0] + near[1] - wanted, 0.0), LAST)
    past = any(k[0] == there for k in known) or (below is not None and there >= below[0])
    return None if past else there


def calibrate(pattern: str, jobs: int, say: Callable[[str], None]) -> None:
    """Write the sizes of effects with names that match a pattern; the others keep theirs."""
    everything = CATALOGUE | OUTSIDE
    found = dict(sizes()) if SIZES.exists() else {}
    chosen = [name for name in everything if fnmatch.fnmatchcase(name, pattern)]
    tasks = [(find, (effect, everything[effect])) for effect in chosen]
    for effect, by_strength in Workers(jobs).spread(tasks):
        found[effect] = by_strength
        say(f"{effect}: {by_strength}")
    found = {effect: found[effect] for effect in everything}
    write_whole(SIZES, json.dumps(found, indent=1) + "\n")
