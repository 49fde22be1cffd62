"""An effect that acts only late in a recording is found there, and held out is what comes after."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, add, simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.hold_out import hold_out_late, hold_out_notes
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import judge
from flexarm_env.identify.select.search import Search
from flexarm_env.identify.select.trace import Trace, Tried
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.thesis import tables

LIMIT = 2.0


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


def recorded(machine: Arm, large: list[float], quantity: str = "current", usual: float = 1.4, most: float = 3.5) -> Recording:
    """Ten seconds of a usual command (1.4 A) both ways, and of the largest one (3.5 A) for 0.2 s at some times [s]."""
    time = np.arange(0.0, 10.0, 0.005)
    command = usual * np.sign(np.sin(2.0 * np.pi * 0.8 * time))
    for start in large:
        command[(time >= start) & (time < start + 0.2)] = most
    return simulate(machine, Recording.from_arrays("late", time, quantity, command, {}, require_signal=False), seed=2)


def shares(arm: Arm, recording: Recording) -> tuple[float, list[str]]:
    nominal, data = prepare(arm, [recording])
    later = hold_out_late(nominal, data)
    assert all((run.train == np.sort(run.train)[::-1]).all() for run in later.runs)
    return float(later.runs[0].train.mean()), hold_out_notes(later)


def test_fits_see_what_shows_only_late(arm):
    share, notes = shares(arm, recorded(arm.with_effect("saturation", limit=LIMIT), [7.2, 8.6]))
    assert 0.73 < share <= 0.9
    assert notes == [f"late: fits see the first {100 * share:.0f} %, not 65 %, since what the model lacks shows late"]


@pytest.mark.parametrize("large", [[2.0, 8.6], [2.0], []])
def test_nothing_changes_where_it_shows_before_or_never(arm, large):
    machine = arm.with_effect("saturation", limit=LIMIT)
    assert shares(arm, recorded(machine, large)) == (pytest.approx(0.65), [])


@pytest.mark.slow(minutes=1)
def test_an_effect_that_acts_only_late_can_be_added(arm):
    found = add("saturation", arm, [recorded(arm.with_effect("saturation", limit=LIMIT), [7.2, 8.6])])
    assert found.error["refitted"] > 2.0
    assert found.error["final"] < 1.1
    limit = next(e for e in found.estimates if e.path == "effects.saturation.limit")
    assert limit.low < LIMIT < limit.high


def test_recordings_keep_what_is_held_out_where_little_would_be_left():
    """A motor that runs down: most samples lie in its first slope, and two show that it stops."""
    model, recordings = tables.experiment_3()
    nominal, data = prepare(model, recordings)
    later = hold_out_late(Calibrator(nominal, data).calibrate_constants().arm, data)
    assert [run.train.tolist() for run in later.runs] == [run.train.tolist() for run in data.runs]
    assert hold_out_notes(later) == []


def test_fits_see_more_where_an_effect_explains_only_what_they_saw():
    """Friction all the time, and an amplifier's limit late: constants fail everywhere, and with friction late alone."""
    arm = Arm.load("cu-rigid")
    friction = arm.with_effect("coulomb", torque=0.1)
    nominal, data = prepare(arm, [recorded(friction.with_effect("saturation", limit=5.0), [7.2, 8.6], "voltage", 3.0, 8.0)])
    calibrator = Calibrator(nominal, data)
    without, tried = (calibrator.uncalibrated(each) for each in (nominal, nominal.with_effect("coulomb", torque=0.1)))
    base = judge((), without, data)
    search = Search(calibrator, ThresholdCriteria(base.score, base.score, True, SETTINGS))
    trace = Trace.begin(base)
    assert search.hold_out_late(trace) is calibrator
    later = search.hold_out_late(trace.then("fit", tried=[Tried("coulomb", 0.0, tried), Tried("viscous", 0.0, without)]))
    assert later.dataset.runs[0].train.mean() > 0.73 > data.runs[0].train.mean()
