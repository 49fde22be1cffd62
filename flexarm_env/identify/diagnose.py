"""Diagnose an arm: are wrong constants or missing effects to blame, which ones, and which arm has them?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.conclude import at_fault, conclude, insufficient, verdict_of, with_outlook
from flexarm_env.identify.deadline import Deadline
from flexarm_env.identify.inspect.clock import is_drive_delay
from flexarm_env.identify.inspect.inspection import inspect_recordings
from flexarm_env.identify.progress import Progress, ProgressCallback
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import error_measure
from flexarm_env.identify.replay.hold_out import hold_out_notes
from flexarm_env.identify.replay.preflight import preflight
from flexarm_env.identify.results import Diagnosis
from flexarm_env.identify.select.criteria import CriteriaFactory, ThresholdCriteria
from flexarm_env.identify.select.model import judge
from flexarm_env.identify.select.search import Search
from flexarm_env.identify.select.trace import Trace
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.identify.workers import Workers
from flexarm_env.recordings.recording import Recording


def diagnose(
    arm: Arm,
    recordings: Sequence[Recording],
    progress: ProgressCallback | None = None,
    seed: int = 0,
    jobs: int = 2,
    settings: Settings = SETTINGS,
    criteria: CriteriaFactory = ThresholdCriteria,
    rate: float | None = None,
    time_limit: float | None = None,
) -> Diagnosis:
    """Diagnose an arm against recordings.

    Args:
        arm: the model.
        recordings: of the machine.
        progress: called with the share done and a text.
        seed: recorded with the result; the search itself draws nothing at random.
        jobs: processes.
        settings: numbers of the method.
        criteria: by which effects are accepted.
        rate: samples per second [Hz] that are kept; 0 keeps all. By default, as many as the arm needs.
        time_limit: time [s] after which nothing more is tried. What runs then is finished, and the conclusion is drawn from it.

    Returns:
        The verdict, the missing effects, and the corrected arm; or the faults of the recordings, which are looked for first.

    Raises:
        InputError: for recordings that do not fit the arm, and a time limit that is none.

    Example:
        >>> from flexarm_env import Arm, diagnose, simulate
        >>> arm = Arm.load("cu-rigid")
        >>> found = diagnose(arm, [simulate(arm, "pulse", duration=2.0, rate=200.0)], jobs=1)
        >>> found.verdict, found.effects
        ('nothing_missing', [])
    """
    deadline = Deadline.after(time_limit)
    constants, searching, searching_again, outlook = Progress.to(progress).split(1, 16, 2, 1)
    nominal, dataset = prepare(arm, recordings, settings, rate)
    constants.at(0.0, "inspecting the recordings")
    inspected = inspect_recordings(arm, recordings, settings)
    late = is_drive_delay(inspected.faults, len(recordings), settings.motion)
    if inspected.faults and not late:
        return _with_run_facts(at_fault(arm, inspected.faults, settings), [], deadline, seed)
    checked = preflight(dataset)
    notes = [fault.line for fault in inspected.faults] + list(checked.notes)
    calibrator = Calibrator(nominal, dataset, Workers(jobs, deadline))
    if checked.too_poor:
        return _with_run_facts(insufficient(arm, calibrator), notes, deadline, seed)

    constants.at(0.0, "refitting the constants")
    with calibrator.workers.threads():
        calibrator, calibration = calibrator.choose_hold_out()
    search, trace = _search(calibrator, calibration, criteria, searching)
    if (later := search.hold_out_late(trace)) is not calibrator:
        with later.workers.threads():
            calibration = later.calibrate_constants()
        again, longer = _search(later, calibration, criteria, searching_again)
        if again.criteria.is_fully_explained(longer.model):
            search, trace = again, longer
    calibrator, rules = search.calibrator, search.criteria  # all that follows is judged on this one's dataset
    nominal_score = calibrator.score(nominal)

    outlook.at(0.0, "concluding")
    found = conclude(verdict_of(trace, rules), trace, nominal_score, arm, recordings, calibrator, seed)
    if deadline.is_over:
        trace = trace.stopped_before("detection limits were estimated", deadline)
    else:
        outlook.at(0.5, "estimating detection limits")
        found = with_outlook(found, trace, calibrator)
    found = replace(found, stopped=None if time_limit is None else trace.stop is not None)
    notes = notes + hold_out_notes(calibrator.dataset) + trace.notes
    return _with_run_facts(found, notes, deadline, seed)


def _search(
    calibrator: Calibrator, constants: Calibration, criteria: CriteriaFactory, progress: Progress
) -> tuple[Search, Trace]:
    base, nominal = judge((), constants, calibrator.dataset), calibrator.nominal
    rules = criteria(calibrator.score(nominal), base.score, error_measure(nominal).judges_free_run, calibrator.settings)
    search = Search(calibrator, rules)
    return search, search.settle(search.run(base, progress))


def _with_run_facts(found: Diagnosis, notes: list[str], deadline: Deadline, seed: int) -> Diagnosis:
    return replace(found, notes=notes + found.notes, seconds=deadline.elapsed, seed=seed)
