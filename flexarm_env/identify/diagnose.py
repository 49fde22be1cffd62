"""Tell whether wrong constants or missing effects are to blame, which, and return the arm that has them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from flexarm_env.arm import Arm, short_name
from flexarm_env.experiments.next_run import propose
from flexarm_env.identify.acceptance import LEAST_REMOVED, PERFECT, WHOLE
from flexarm_env.identify.data import Data, prepare
from flexarm_env.identify.hiding import could_hide
from flexarm_env.identify.hypothesis import excess
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.origin import with_origin
from flexarm_env.identify.preflight import preflight
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.refit import Progress, estimates, with_all
from flexarm_env.identify.results import Candidate, Diagnosis, Estimate
from flexarm_env.identify.search import Search
from flexarm_env.identify.split import later_notes, refit_and_split
from flexarm_env.recordings.recording import Recording


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
    if insufficient:
        return _insufficient(arm, nominal, data, score(nominal, data), notes, began, seed)
    say(0.05, "refitting the constants")
    with in_threads(jobs):
        base, data = refit_and_split(nominal, data)
    notes += later_notes(data)
    before, first = score(nominal, data), score(base.arm, data)
    search = Search(nominal, data, jobs, say)
    search.run(base, before, first)
    with in_threads(jobs):
        found = _conclude(arm, nominal, data, search, before, first, notes, began, seed, recordings)
    return replace(_with_outlook(found, search, data, say, jobs), seconds=time.perf_counter() - began)


def _verdict(search: Search, before: Score, first: Score) -> str:
    if search.accepted and search.rules.explains(search.best):
        return "effects"
    if first.windows > WHOLE:
        return "unknown"
    needed = excess(before.windows) > 1.5 * excess(first.windows) and before.windows > PERFECT
    return "parameters" if needed else "nothing_missing"


def _conclude(
    arm: Arm,
    nominal: Arm,
    data: Data,
    search: Search,
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
    final = with_all(final, nominal, data)
    values = estimates(final, nominal)
    accepted = search.accepted if named else []
    steps = {name: search.steps[name] for name in accepted}
    if named and last.windows > WHOLE:
        rest = f"the corrected model still errs by {last.windows:.3g} times the noise: more is missing, or the noise is larger"
        notes = [*notes, f"{rest} than the arm file says"]
    corrected = with_origin(arm, final.arm, values, recordings, "diagnose", seed) if verdict != "nothing_missing" else arm
    return Diagnosis(
        verdict=verdict,
        effects=list(accepted),
        equivalent=search.equivalent if named else [],
        ranking=_ranking(search, values, accepted, nominal),
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


def _ranking(search: Search, values: Sequence[Estimate], accepted: Sequence[str], nominal: Arm) -> list[Candidate]:
    """Return every effect that was tried: the accepted ones in their order, then the others, those that remove most first."""
    ranking = []
    for name, (gain, found) in sorted(search.ranking.items(), key=lambda item: -item[1][0]):
        own = values if name in accepted else (estimates(found, nominal) if found else [])
        own = [e for e in own if e.path.startswith(f"effects.{name}.")]
        ranking.append(Candidate(name, gain, name in accepted, own))
    return sorted(ranking, key=lambda c: accepted.index(c.effect) if c.accepted else len(accepted))


def _with_outlook(found: Diagnosis, search: Search, data: Data, say: Progress, jobs: int) -> Diagnosis:
    """Return the diagnosis with what could still hide, and what to record next where the recordings leave something open."""
    say(0.95, "sizing what could hide")
    smallest = {} if found.verdict == "unknown" else could_hide(search.found, data, LEAST_REMOVED, jobs)
    hypotheses = search.open_hypotheses()
    next_run = propose(hypotheses, data.interval) if len(hypotheses) > 1 and found.verdict == "effects" else None
    return replace(found, smallest=smallest, next_run=next_run)


def _insufficient(arm: Arm, nominal: Arm, data: Data, before: Score, notes: list[str], began: float, seed: int) -> Diagnosis:
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
        next_run=propose({"": nominal}, data.interval),
    )
