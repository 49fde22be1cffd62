"""The diagnosis that a search ends in: final calibration, intervals, ranking, detection limits and the next run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flexarm_env.arm import Arm, short_name
from flexarm_env.experiments.next_run import propose
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.calibrate.intervals import estimates
from flexarm_env.identify.explain.budget import Budget, budget, budget_notes, rest_notes, torque_notes
from flexarm_env.identify.explain.detection_limits import detection_limits
from flexarm_env.identify.explain.error_steps import ErrorStep, error_steps
from flexarm_env.identify.explain.moved_constants import moved_notes
from flexarm_env.identify.explain.probability import probabilities
from flexarm_env.identify.explain.unexplained_torque import unexplained_torque
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.origin import with_origin
from flexarm_env.identify.replay.error_measure import Score, closed_loop_errors
from flexarm_env.identify.results import NAMING, Candidate, Diagnosis
from flexarm_env.identify.select.criteria import Criteria
from flexarm_env.identify.select.trace import Trace, Tried
from flexarm_env.identify.settings import Settings
from flexarm_env.recordings.recording import Recording


def conclude(
    verdict: str,
    trace: Trace,
    nominal_score: Score,
    arm: Arm,
    recordings: Sequence[Recording],
    calibrator: Calibrator,
    seed: int,
) -> Diagnosis:
    """Calibrate the arm that the verdict names on all of the data, and collect the findings on it.

    Args:
        verdict: of the criteria.
        trace: of the search.
        nominal_score: errors of the arm as given.
        arm: as given, with all its sensors.
        recordings: of the machine.
        calibrator: of the recordings.
        seed: recorded with the result.
    """
    nominal, base = calibrator.nominal, trace.steps[0].model
    model, accepted = (trace.model, trace.accepted) if verdict in NAMING else (base, ())
    steps = error_steps(nominal_score, trace, [a.effect for a in accepted], calibrator)
    shares = budget(steps, calibrator.settings)
    if verdict in (*NAMING, "unknown"):
        arms = {"nominal": nominal, "constants": base.arm, **({"final": model.arm} if accepted else {})}
        torque = {name: unexplained_torque(one, calibrator.dataset) for name, one in arms.items()}
        shares = replace(shares, torque=torque)
    with calibrator.workers.threads():
        final = (calibrator.finish if accepted else calibrator.calibrate_on_all_data)(model.calibration)
        values = estimates(final, nominal)
        ranking = _ranking(trace, steps[1:], values, nominal)
    scores = {"nominal": nominal_score, "refitted": base.score, **{s.name: s.after for s in steps[1:]}, "final": model.score}
    free = ("nominal", "refitted", "final")
    corrected = arm
    if verdict != "nothing_missing":
        corrected = with_origin(arm, final.arm, values, recordings, "diagnose", seed, calibrator.settings)
    return Diagnosis(
        verdict=verdict,
        effects=[a.effect for a in accepted],
        equivalent=[list(a.equivalent) for a in accepted],
        probability=probabilities(
            [a.equivalent for a in accepted],
            0.0 if verdict == "effects" else model.score.excess / base.score.excess,
            calibrator.settings.probabilities,
        ),
        ranking=ranking,
        error={name: score.windows for name, score in scores.items()},
        free_run={name: scores[name].free_run for name in free},
        constants={short_name(e.path): e for e in values},
        arm=corrected,
        nominal=arm,
        refitted=base.arm,
        notes=[*_notes(verdict, steps, shares, calibrator.settings), *moved_notes(final, calibrator.settings.explaining)],
        trace=trace.as_json(),
        settings=calibrator.settings,
        seed=seed,
        closed_loop=closed_loop_errors(dict(zip(free, (nominal, base.arm, model.arm), strict=True)), calibrator.dataset),
        budget=shares,
    )


def verdict_of(trace: Trace, criteria: Criteria) -> str:
    """Reach the verdict of a search; without effects it is "unknown" where one that was left out might have been accepted."""
    base = trace.steps[0].model
    verdict = criteria.verdict(trace.effects, base, trace.model)
    is_open = trace.stop is not None and not trace.accepted and not criteria.is_sufficient(base)
    return "unknown" if is_open else verdict


def with_outlook(found: Diagnosis, trace: Trace, calibrator: Calibrator) -> Diagnosis:
    """Add detection limits, and the run to record next where the recordings leave something open."""
    smallest = {} if found.verdict == "unknown" else detection_limits(calibrator, trace.model.calibration)
    hypotheses = trace.open_hypotheses
    is_open = len(hypotheses) > 1 and found.verdict in NAMING
    next_run = propose(hypotheses, calibrator.dataset.interval) if is_open else None
    return replace(found, smallest=smallest, next_run=next_run)


def insufficient(arm: Arm, calibrator: Calibrator) -> Diagnosis:
    """Build the diagnosis of recordings that are too poor to judge an arm, with the run to record next."""
    nominal = calibrator.nominal
    score = calibrator.score(nominal)
    names = ("nominal", "refitted", "final")
    return Diagnosis(
        verdict="insufficient_data",
        effects=[],
        equivalent=[],
        ranking=[],
        error=dict.fromkeys(names, score.windows),
        free_run=dict.fromkeys(names, score.free_run),
        constants={},
        arm=arm,
        nominal=arm,
        refitted=nominal,
        notes=[],
        next_run=propose({"": nominal}, calibrator.dataset.interval),
        settings=calibrator.settings,
        closed_loop=closed_loop_errors(dict.fromkeys(names, nominal), calibrator.dataset),
    )


def at_fault(arm: Arm, faults: Sequence[Fault], settings: Settings) -> Diagnosis:
    """Build the diagnosis of recordings that are at fault: no model is judged by them."""
    unknown = dict.fromkeys(("nominal", "refitted", "final"), float("nan"))
    return Diagnosis(
        verdict="recordings",
        effects=[],
        equivalent=[],
        ranking=[],
        error=unknown,
        free_run=unknown,
        constants={},
        arm=arm,
        nominal=arm,
        refitted=arm,
        notes=[],
        recordings=list(faults),
        settings=settings,
    )


def _ranking(trace: Trace, accepted: Sequence[ErrorStep], values: Sequence[Estimate], nominal: Arm) -> list[Candidate]:
    """List every effect that was tried: accepted ones in their order, then the others, those that remove most first.

    An effect that was accepted beside another, and never tried alone, gains what its step removes.
    """
    names = [step.name for step in accepted]
    untried = [Tried(s.name, _gain(s, accepted[0].before)) for s in accepted if s.name not in trace.ranking]
    ranking = []
    for tried in sorted([*trace.ranking.values(), *untried], key=lambda one: -one.gain):
        own = values if tried.effect in names else estimates(tried.calibration, nominal) if tried.calibration else []
        own = [e for e in own if e.path.startswith(f"effects.{tried.effect}.")]
        ranking.append(Candidate(tried.effect, tried.gain, tried.effect in names, own))
    return sorted(ranking, key=lambda c: names.index(c.effect) if c.accepted else len(names))


def _gain(step: ErrorStep, refitted: Score) -> float:
    """Compute the share of the refitted excess that a step removes, 0 to 1."""
    return min(max((step.before.excess - step.after.excess) / refitted.excess, 0.0), 1.0)


def _notes(verdict: str, steps: Sequence[ErrorStep], shares: Budget, settings: Settings) -> list[str]:
    """Describe the error that the named effects leave, and what a step made worse."""
    rest = rest_notes(shares, steps[-1].after.windows, settings) if verdict in NAMING else []
    return [*rest, *torque_notes(shares, [step.name for step in steps[1:]]), *budget_notes(steps, settings)]
