"""The page of recordings of which not all samples were kept: every arm is drawn at the samples of the arm as given."""

from __future__ import annotations

import pytest

from flexarm_env import Arm, compare, diagnose, simulate
from flexarm_env.terminal.report import report

pytest.importorskip("plotly")


def test_every_arm_is_replayed_and_every_curve_estimated_at_the_kept_samples(monkeypatch):
    arm = Arm.load("cu-rigid")
    run = simulate(arm.with_effect("constant_torque", torque=0.02), "square", duration=3.0, rate=1000.0, seed=1, name="run")
    before = compare(arm, [run], rate=200.0)
    assert before.rate == pytest.approx(200.0)
    assert len(before.replays[0].time) == len(run) / 5
    assert compare(arm, [run], rate=0.0).rate == 0.0
    found = diagnose(arm, [run], rate=200.0, jobs=1)
    assert found.effects == ["constant_torque"]
    assert "constant_torque" in report([run], before, found, {})
    curves = []
    monkeypatch.setattr("flexarm_env.terminal.report.effect_curve", lambda *arguments: curves.append(arguments[-1]))
    report([run], before, found, {})
    assert [(data.interval, len(data.runs[0].time)) for data in curves] == [(pytest.approx(0.005), len(run) / 5)]
