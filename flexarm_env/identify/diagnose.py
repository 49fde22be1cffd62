"""Tell whether wrong constants or missing effects are to blame, which, and return the arm that has them."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from joblib import Parallel, delayed

from flexarm_env.arm import Arm, short_name
from flexarm_env.identify.data import Data, prepare
from flexarm_env.identify.origin import with_origin
from flexarm_env.identify.preflight import preflight
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.recording import Recording
from flexarm_env.identify.refit import Progress, Refit, best_refit, estimates, polish, refit
from flexarm_env.identify.results import Candidate, Diagnosis
from flexarm_env.identify.screen import (
    CANDIDATE_LEVELS,
    Base,
    Trial,
    attempt,
    best_trials,
    candidates,
    screening_base,
    signatures,
)

#: How many candidates are refitted in full in each round.
FINALISTS = 4
#: A held-out error below this leaves nothing to explain.
PERFECT = 1.08
#: Least share of the excess error that an effect must remove to be accepted, and all accepted ones together.
LEAST_GAIN, LEAST_TOTAL_GAIN = 0.15, 0.5
#: A model whose held-out error ends below this is whole, whatever share was removed.
WHOLE = 1.2
MOST_EFFECTS = 3
#: Two effects are equivalent if the error they leave differs by less than this share of what they remove.
SAME_GAIN = 0.03


def excess(value: float) -> float:
    """Return the excess of an error over the noise, as a variance."""
    return max(value**2 - 1.0, 1e-9)


def diagnose(
    arm: Arm, recordings: Sequence[Recording], progress: Progress | None = None, seed: int = 0, jobs: int = 2
) -> Diagnosis:
    """Diagnose an arm against recordings.

    Args:
        arm: the model.
        recordings: of the machine.
        progress: called with the share done and what is being done.
        seed: recorded with the result; the search itself draws nothing at random.
        jobs: processes.

    Returns:
        The verdict, what is missing, and the corrected arm.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    began = time.perf_counter()
    say = progress or (lambda done, text: None)
    nominal, data = prepare(arm, recordings)
    notes, insufficient = preflight(nominal, data)
    say(0.02, "replaying the model")
    before = score(nominal, data)
    if insufficient:
        return _insufficient(arm, nominal, before, notes, began, seed)
    say(0.05, "refitting the constants")
    base = best_refit(nominal, data)
    first = score(base.arm, data)
    search = _Search(nominal, data, jobs, say)
    search.run(base, first)
    return _conclude(arm, nominal, data, search, before, first, notes, began, seed, recordings)


class _Search:
    """Forward search: add the best effect, refit, and again, until nothing is left or nothing helps."""

    def __init__(self, nominal: Arm, data: Data, jobs: int, say: Progress) -> None:
        self.nominal, self.data, self.jobs, self.say = nominal, data, jobs, say
        self.accepted: list[str] = []
        self.equivalent: list[list[str]] = []
        self.steps: dict[str, Score] = {}
        self.ranking: dict[str, tuple[float, Refit | None]] = {}

    def run(self, base: Refit, first: Score) -> None:
        """Search from the refitted constants."""
        self.base, self.first = base, first
        self.found, self.best = base, first
        for round_ in range(MOST_EFFECTS):
            if round_ and self.best.windows < PERFECT:
                break
            if not self._add_one(0.1 + 0.3 * round_, 0.3):
                break
        self._drop_useless()

    def _add_one(self, done: float, share: float) -> bool:
        worth = self.best.windows >= PERFECT
        trials = self._screen(done, 0.6 * share)
        if not self.ranking:
            self._rank_screened(trials)
        if not worth:
            return False
        finalists = [t for t in trials if t.effect][:FINALISTS]
        refits = self._refit_all(finalists, done + 0.6 * share, 0.4 * share)
        scored = sorted(((score(r.arm, self.data), t.effect, r) for t, r in refits), key=lambda x: x[0].windows)
        for value, effect, found in scored:
            self._remember(effect, 1.0 - excess(value.windows) / excess(self.first.windows), found)
        value, effect, found = scored[0]
        removed = excess(self.best.windows) - excess(value.windows)
        if removed < LEAST_GAIN * excess(self.best.windows):
            return False
        tolerance = SAME_GAIN * removed
        same = [e for v, e, _ in scored if excess(v.windows) <= excess(value.windows) + tolerance]
        found = polish(found, self.nominal, self.data)
        value = score(found.arm, self.data)
        self.accepted.append(effect)
        self.equivalent.append(same)
        self.found, self.best = found, value
        self.steps[effect] = value
        return True

    def _remember(self, effect: str, gain: float, found: Refit | None) -> None:
        if effect not in self.accepted:
            self.ranking[effect] = (float(np.clip(gain, 0.0, 1.0)), found)

    def _rank_screened(self, trials: list[Trial]) -> None:
        reference = next(t for t in trials if not t.effect)
        for trial in trials:
            if trial.effect:
                gain = 1.0 - trial.held_out / reference.held_out
                self.ranking[trial.effect] = (float(np.clip(gain, 0.0, 1.0)), None)

    def _screen(self, done: float, share: float) -> list[Trial]:
        base = screening_base(self.found, self.data)
        names = candidates(self.found.arm)
        tasks = [delayed(_try_effect)(base, name) for name in names]
        trials = [attempt(base, None)]
        for i, found in enumerate(self._parallel(tasks)):
            trials += found
            self.say(done + share * (i + 1) / len(names), f"trying {len(names)} effects")
        return best_trials(trials)

    def _refit_all(self, finalists: list[Trial], done: float, share: float) -> list[tuple[Trial, Refit]]:
        tasks = [delayed(_refit_trial)(trial, self.nominal, self.data) for trial in finalists]
        out = []
        for i, pair in enumerate(self._parallel(tasks)):
            out.append(pair)
            self.say(done + share * (i + 1) / len(tasks), f"refitting with {pair[0].effect}")
        return out

    def _parallel(self, tasks):  # type: ignore[no-untyped-def]
        return Parallel(n_jobs=self.jobs, return_as="generator")(tasks)

    def _drop_useless(self) -> None:
        """Take out an effect that the later ones have made needless."""
        for effect in self.accepted[:-1]:
            without = refit(self.found.arm.without_effect(effect), self.nominal, self.data, CANDIDATE_LEVELS)
            value = score(without.arm, self.data)
            if excess(value.windows) - excess(self.best.windows) < LEAST_GAIN * excess(value.windows):
                self.found, self.best = without, value
                place = self.accepted.index(effect)
                del self.accepted[place], self.equivalent[place], self.steps[effect]


def _try_effect(base: Base, name: str) -> list[Trial]:
    return [attempt(base, signature) for signature in signatures(base, name)]


def _refit_trial(trial: Trial, nominal: Arm, data: Data) -> tuple[Trial, Refit]:
    return trial, refit(trial.arm, nominal, data, CANDIDATE_LEVELS)


def _verdict(search: _Search, before: Score, first: Score) -> str:
    total = 1.0 - excess(search.best.windows) / excess(first.windows)
    if search.accepted and (total >= LEAST_TOTAL_GAIN or search.best.windows <= WHOLE):
        return "effects"
    if first.windows > WHOLE:
        return "unknown"
    needed = excess(before.windows) > 1.5 * excess(first.windows) and before.windows > PERFECT
    return "parameters" if needed else "nothing_missing"


def _conclude(
    arm: Arm,
    nominal: Arm,
    data: Data,
    search: _Search,
    before: Score,
    first: Score,
    notes: list[str],
    began: float,
    seed: int,
    recordings: Sequence[Recording],
) -> Diagnosis:
    verdict = _verdict(search, before, first)
    named = verdict == "effects"
    final = search.found if named else search.base
    last = search.best if named else first
    values = estimates(final, nominal)
    accepted = search.accepted if named else []
    steps = {name: search.steps[name] for name in accepted}
    corrected = with_origin(arm, final.arm, values, recordings, "diagnose", seed) if verdict != "nothing_missing" else arm
    ranking = []
    for name, (gain, found) in sorted(search.ranking.items(), key=lambda item: -item[1][0]):
        own = values if name in accepted else (estimates(found, nominal) if found else [])
        own = [e for e in own if e.path.startswith(f"effects.{name}.")]
        ranking.append(Candidate(name, gain, name in accepted, own))
    ranking.sort(key=lambda c: accepted.index(c.effect) if c.accepted else len(accepted))
    return Diagnosis(
        verdict=verdict,
        effects=list(accepted),
        equivalent=search.equivalent if named else [],
        ranking=ranking,
        error={"nominal": before.windows, "refitted": first.windows}
        | {name: s.windows for name, s in steps.items()}
        | {"final": last.windows},
        free_run={"nominal": before.free_run, "refitted": first.free_run, "final": last.free_run},
        constants={short_name(e.path): e for e in values},
        arm=corrected,
        nominal=arm,
        refitted=search.base.arm,
        notes=notes,
        seconds=time.perf_counter() - began,
        seed=seed,
    )


def _insufficient(arm: Arm, nominal: Arm, before: Score, notes: list[str], began: float, seed: int) -> Diagnosis:
    same = {"nominal": before.windows, "refitted": before.windows, "final": before.windows}
    free = {"nominal": before.free_run, "refitted": before.free_run, "final": before.free_run}
    return Diagnosis(
        verdict="insufficient_data",
        effects=[],
        equivalent=[],
        ranking=[],
        error=same,
        free_run=free,
        constants={},
        arm=arm,
        nominal=arm,
        refitted=nominal,
        notes=notes,
        seconds=time.perf_counter() - began,
        seed=seed,
    )
