"""A search with a time limit: what was found in time counts, and what was left out is named."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import count
from types import SimpleNamespace

import pytest

from flexarm_env import Arm, InputError, diagnose
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.conclude import verdict_of
from flexarm_env.identify.deadline import Deadline
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.select.trace import Accepted, Trace
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.identify.workers import Workers


def counted(limit: float) -> Deadline:
    """A deadline whose clock goes on by a second with each look."""
    return Deadline.after(limit, count().__next__)


@pytest.mark.parametrize("limit", [0.0, -1.0, math.nan, math.inf])
def test_a_limit_that_is_no_time_is_refused(limit):
    with pytest.raises(InputError, match="seconds above 0"):
        diagnose(Arm.load("cu-rigid"), [], time_limit=limit)


def test_no_task_starts_after_the_deadline():
    done = []
    tasks = [(done.append, (number,)) for number in range(10)]
    assert list(Workers(1, counted(4.0)).map_in_time(tasks)) == [None] * len(done)
    assert done == [0, 1]
    assert len(list(Workers(1, counted(4.0)).map(tasks))) == 10
    assert len(list(Workers(1).map_in_time(tasks))) == 10


def found_by(base: float, accepted: float | None, is_stopped: bool) -> str:
    """The verdict of a search from an error of the constants to one of an accepted effect."""
    arm, score = Arm.load("thesis"), Score(base, base)
    first = Model((), SimpleNamespace(arm=arm), score, score)
    trace = Trace.begin(first)
    if accepted is not None:
        best = replace(first, score=Score(accepted, accepted))
        trace = trace.then("accept", best, [Accepted("backlash", ("backlash",), best.score)])
    if is_stopped:
        trace = trace.stopped_before("an effect was tried", Deadline.after(1.0))
    return verdict_of(trace, ThresholdCriteria(score, score, True, SETTINGS))


def test_a_stopped_search_claims_no_more_than_it_has_seen():
    between = 0.5 * (SETTINGS.errors.nothing_left + SETTINGS.errors.explained)
    assert found_by(between, None, is_stopped=False) == "nothing_missing"
    assert found_by(between, None, is_stopped=True) == "unknown"
    assert found_by(1.0, None, is_stopped=True) == "nothing_missing"
    assert found_by(5.0, None, is_stopped=True) == "unknown"
    assert found_by(5.0, 1.0, is_stopped=True) == found_by(5.0, 1.0, is_stopped=False) == "effects"


def test_a_diagnosis_with_a_limit_names_what_was_left_out():
    arm = Arm.load("cu-rigid")
    recording = simulate(arm.with_effect("coulomb", torque=0.05), "square", duration=2.0, rate=100.0, seed=1)
    found = diagnose(arm, [recording], jobs=1, time_limit=1e-3)
    assert (found.verdict, found.effects, found.stopped) == ("unknown", [], True)
    (note,) = [note for note in found.notes if note.startswith("stopped after")]
    assert note.endswith("s, before an effect was tried")
    assert found.smallest == {}
    assert found.as_json()["stopped"] is True
    assert found.error["final"] == found.error["refitted"] < found.error["nominal"]
