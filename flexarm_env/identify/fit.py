"""Refit an arm's constants, and add one effect to it."""

from __future__ import annotations

import time
from collections.abc import Sequence

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.data import prepare
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.origin import with_origin
from flexarm_env.identify.problem import score
from flexarm_env.identify.refit import Progress, best_refit, estimates, with_all
from flexarm_env.identify.results import Addition, Estimate, Fit
from flexarm_env.identify.screen import refit_effect
from flexarm_env.identify.split import refit_and_split
from flexarm_env.recordings.recording import Recording


def fit(arm: Arm, recordings: Sequence[Recording], progress: Progress | None = None, seed: int = 0, jobs: int = 2) -> Fit:
    """Refit the constants of an arm.

    Args:
        arm: the model, whose values are the centres of the priors.
        recordings: of the machine; the last part of each is held out.
        progress: called with the share done and what is being done.
        seed: recorded with the result.
        jobs: threads.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    began = time.perf_counter()
    say = progress or (lambda done, text: None)
    nominal, data = prepare(arm, recordings)
    say(0.05, "refitting the constants")
    with in_threads(jobs):
        found = best_refit(nominal, data)
        before, after = score(nominal, data), score(found.arm, data)
        final = with_all(found, nominal, data)
        values = estimates(final, nominal)
    say(1.0, "done")
    return Fit(
        arm=with_origin(arm, final.arm, values, recordings, "fit", seed),
        estimates=values,
        error={"nominal": before.windows, "refitted": after.windows},
        free_run={"nominal": before.free_run, "refitted": after.free_run},
        seconds=time.perf_counter() - began,
    )


def add(
    effect: str, arm: Arm, recordings: Sequence[Recording], progress: Progress | None = None, seed: int = 0, jobs: int = 2
) -> Addition:
    """Add one effect to an arm and refit everything.

    Args:
        effect: name of the effect.
        arm: the model.
        recordings: of the machine; the last part of each is held out.
        progress: called with the share done and what is being done.
        seed: recorded with the result.
        jobs: threads.

    Raises:
        InputError: for an unknown effect, one that the arm has already or cannot have, or recordings that do not fit.
    """
    began = time.perf_counter()
    say = progress or (lambda done, text: None)
    if effect in arm.effects and not arm.known[effect].absent(arm.effects[effect]):
        raise InputError(f"arm '{arm.name}' has effect '{effect}' already; `flexarm fit` refits it")
    arm.with_effect(effect)
    nominal, data = prepare(arm.without_effect(effect), recordings)
    say(0.05, "refitting the constants")
    with in_threads(jobs):
        base, data = refit_and_split(nominal, data)
        say(0.4, f"adding {effect}")
        found = refit_effect(effect, base, nominal, data)
        scores = [score(a, data) for a in (nominal, base.arm, found.arm)]
        final = with_all(found, nominal, data)
        values = _effect_first(estimates(final, nominal), effect)
    say(1.0, "done")
    names = ("nominal", "refitted", "final")
    return Addition(
        arm=with_origin(arm, final.arm, values, recordings, f"add {effect}", seed),
        effect=effect,
        estimates=values,
        error={name: s.windows for name, s in zip(names, scores, strict=True)},
        free_run={name: s.free_run for name, s in zip(names, scores, strict=True)},
        seconds=time.perf_counter() - began,
    )


def _effect_first(values: list[Estimate], effect: str) -> list[Estimate]:
    return sorted(values, key=lambda e: not e.path.startswith(f"effects.{effect}."))
