"""The loop of one tab, without a page: recordings, hand-made changes, a diagnosis, what is added, what is taken home."""

from __future__ import annotations

import time
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inspection_results import CUT
from inspection_results import overview as overview_by_hand
from picture_results import diagnosis

from flexarm_env import Arm, InputError, Recording, simulate
from flexarm_env.experiments.next_run import NextRun
from flexarm_env.identify.results import Addition, Diagnosis
from flexarm_env.lab.job import Job
from flexarm_env.lab.session import Session


@pytest.fixture
def session() -> Session:
    made = Session(Arm.load("thesis-fem"))
    made.use([simulate(made.base, "pulse", duration=1.5, rate=200.0)])
    return made


@dataclass
class Ended:
    """Work that has ended with a result."""

    result: Any
    state: str = "done"

    def poll(self) -> bool:
        return True

    def stop(self) -> None:
        """Nothing is under way."""


def ended(session: Session, result: Any) -> None:
    session.job = Ended(result)
    session.poll()


def found(session: Session, **changes: Any) -> Diagnosis:
    arm = session.arm
    return replace(diagnosis(), arm=arm.with_effect("backlash", gap=0.0612), nominal=arm, refitted=arm, **changes)


def test_recordings_begin_a_new_waterfall(session):
    (step,) = session.steps
    assert step[0] == "as given"
    assert 0.8 < step[1] < 1.2  # the arm made the recording itself
    session.tick("backlash", True)
    session.use(session.recordings)
    assert session.draft is session.base


def test_good_uploads_are_taken_and_bad_ones_have_a_line(session, tmp_path):
    good = simulate(session.base, "sweep", duration=1.5, rate=200.0)
    good.write(tmp_path / "good.csv")
    good.part(0.0, 0.1).write(tmp_path / "short.csv")
    files = [(name, (tmp_path / name).read_bytes()) for name in ("short.csv", "good.csv")]
    (line,) = session.upload([*files, ("bad.csv", b"x")])[:1]
    assert "short has 20 samples; at least 50 are needed" in line
    assert [one.name for one in session.recordings] == ["pulse", "good"]
    before = session.steps
    assert len(session.upload([("bad.csv", b"x")])) == 1
    assert session.steps is before


def test_effects_are_ticked_and_dragged_in_the_draft_only(session):
    session.tick("backlash", True)
    session.drag("backlash", "gap", 0.04)
    assert session.draft.effects["backlash"] == {"gap": 0.04}
    assert "backlash" not in session.arm.effects
    with pytest.raises(InputError, match="out of bounds"):
        session.drag("backlash", "gap", -1.0)
    session.tick("backlash", False)
    assert session.draft == session.arm


def test_what_the_diagnosis_found_is_added_at_once_and_once(session):
    ended(session, found(session))
    assert session.can_adopt
    session.add("backlash")
    assert not session.busy
    assert session.arm.effects["backlash"] == {"gap": 0.0612}
    assert [name for name, _ in session.steps] == ["as given", "constants refitted", "+ backlash"]
    assert [value for _, value in session.steps[1:]] == [3.7, 1.02]
    assert not session.can_adopt
    with pytest.raises(InputError, match="nothing to add"):
        session.adopt()


def test_another_effect_is_fitted(session, monkeypatch):
    begun = []
    monkeypatch.setattr("flexarm_env.lab.session.Job", lambda title, work: begun.append(title) or Ended(None, "running"))
    ended(session, found(session))
    session.add("cogging")
    assert begun == ["Adding cogging"]
    arm = session.arm.with_effect("cogging")
    error = {"nominal": 4.0, "refitted": 3.0, "final": 2.0}
    ended(session, Addition(arm, "cogging", [], error, error, 1.0))
    assert session.steps[1:] == [("constants refitted", 3.0), ("+ cogging", 2.0)]
    assert session.draft is arm


def test_a_change_by_hand_is_a_step_of_its_own(session, monkeypatch):
    monkeypatch.setattr("flexarm_env.lab.session.Job", lambda title, work: Ended(None, "running"))
    session.tick("payload", True)
    session.diagnose()
    assert [name for name, _ in session.steps] == ["as given", "by hand"]
    assert session.steps[1][1] > 2.0 * session.steps[0][1]
    with pytest.raises(InputError, match="under way"):
        session.diagnose()


def test_nothing_can_be_diagnosed_without_recordings():
    with pytest.raises(InputError, match="no recordings"):
        Session(Arm.load("thesis")).diagnose()


def test_a_diagnosis_runs_apart_and_stops(session):
    session.diagnose()
    assert isinstance(session.job, Job)
    assert session.busy
    end = time.monotonic() + 60.0
    while session.revision == 0 and time.monotonic() < end:
        session.poll()
        time.sleep(0.02)
    assert session.revision > 0
    session.stop()
    assert not session.busy
    assert session.diagnosis is None


def test_another_arm_must_fit_the_recordings(session):
    with pytest.raises(InputError, match="driven by voltage"):
        session.change_arm(Arm.load("cu-rigid"))
    assert session.base.name == "thesis-fem"
    session.change_arm(Arm.load("thesis"))
    assert session.base.name == "thesis"


def test_the_arm_file_is_that_of_the_draft_and_keeps_no_interval_that_does_not_hold(session, tmp_path):
    fitted = {path: {"value": v, "low": v, "high": v, "unit": "rad"} for path, v in (("effects.backlash.gap", 0.0612),)}
    better = replace(session.arm.with_effect("backlash", gap=0.0612), fitted=fitted)
    session.arm = session.draft = better
    assert tomllib.loads(session.arm_file())["fitted"]
    session.drag("backlash", "gap", 0.05)
    text = session.arm_file()
    assert "fitted" not in tomllib.loads(text)
    (tmp_path / "arm.toml").write_text(text)
    assert Arm.load(tmp_path / "arm.toml").effects["backlash"]["gap"] == 0.05


def test_the_report_names_all_options_of_the_command_line(session, monkeypatch):
    begun = []
    monkeypatch.setattr("flexarm_env.lab.session.Job", lambda title, work: begun.append(work) or Ended(None, "running"))
    monkeypatch.setattr(
        "flexarm_env.lab.session.report", lambda recordings, before, diagnosis, made, progress: made["command_line"]
    )
    session.columns, session.effects, session.arm_named = Path("my map.toml"), ["mine.py:Mine"], "arms/mine.toml"
    session.write_report()
    line = begun[0](lambda share, text: None)
    assert line == "flexarm compare pulse --arm arms/mine.toml --columns 'my map.toml' --effects mine.py:Mine"


def test_the_next_run_is_a_file_that_can_be_played(session, tmp_path):
    assert session.next_run() is None
    run = NextRun("a chirp", (), 0.0, np.arange(100) * 0.01, np.sin(np.arange(100) * 0.1), "current")
    object.__setattr__(session, "diagnosis", found(session))
    object.__setattr__(session.diagnosis, "next_run", run)
    path = tmp_path / "next.csv"
    path.write_text(session.next_run())
    played = Recording.read(path, require_signal=False)
    assert np.allclose(played.command, run.command, rtol=0.0, atol=0.0)


def test_recordings_are_inspected_as_they_come_and_their_page_is_written(session, monkeypatch):
    assert session.inspection.faults == ()
    run = session.recordings[0]
    lost = run.signals["arm_angle"].copy()
    lost[200:205] = 0.0
    session.use([replace(run, signals=run.signals | {"arm_angle": lost})])
    (fault,) = session.inspection.faults
    assert (fault.signal, fault.kind) == ("arm_angle", "dropout")
    begun = []
    monkeypatch.setattr("flexarm_env.lab.session.Job", lambda title, work: begun.append((title, work)) or Ended("<html>"))
    session.write_inspection()
    ((title, work),) = begun
    assert title == "Inspecting"
    monkeypatch.setattr("flexarm_env.lab.session.overview", lambda arm, recordings, progress, inspection: overview_by_hand(CUT))
    assert CUT.message in work(lambda done, text: None)
    session.use([])
    assert session.inspection is None
