"""The benchmark of a diagnosis: its machines move as their models with what they hide, and its counts are complete."""

from __future__ import annotations

import json

import pytest

from benchmarks.diagnosis import cases, measure, table
from benchmarks.diagnosis.cases import CASES, Case
from benchmarks.diagnosis.count import PARTS, STAGES, counting
from benchmarks.diagnosis.machine import BEAM_DAMPING, FALLOFF
from flexarm_env import Arm, diagnose, simulate
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score
from flexarm_env.plant.plant import Plant

KINDS = {
    "rigid_voltage": cases.RIGID_VOLTAGE,
    "rigid_current": cases.RIGID_CURRENT,
    "flexible_tip": cases.FLEXIBLE_TIP,
    "flexible_strain": cases.FLEXIBLE_STRAIN,
}


def machine_of(made):
    """The arm of a machine with all that it hides."""
    arm = made.arm.with_effect("coulomb", torque=made.coulomb)
    arm = arm.with_effect("viscous", coefficient=made.viscous) if made.viscous else arm
    arm = arm.with_effect("constant_torque", torque=made.torque) if made.torque else arm
    arm = arm.with_effect("cable_stiffness", stiffness=made.cable, rest_angle=0.0) if made.cable else arm
    arm = arm.with_effect("stribeck", extra=made.stribeck, falloff_speed=FALLOFF) if made.stribeck else arm
    return arm.with_effect("beam_damping", time=BEAM_DAMPING) if made.arm.has("beam") else arm


def small():
    arm = Arm.load("cu-rigid")
    return arm, [simulate(arm.with_effect("coulomb", torque=0.05), "square", duration=2.0, rate=100.0)]


@pytest.mark.parametrize("kind", KINDS)
def test_machines_move_as_their_models_with_what_they_hide(kind):
    made = KINDS[kind]
    recordings = [made.record(experiment, 1) for experiment in ("square", "sweep")]
    hidden, dataset = prepare(machine_of(made), recordings, rate=0)
    assert score(hidden, dataset).windows < 1.25
    model, dataset = prepare(made.arm, recordings, rate=0)
    assert score(model, dataset).windows > 10.0


def test_all_groups_of_the_goals_have_cases():
    counts = [sum(case.group == group for case in CASES.values()) for group in dict.fromkeys(c.group for c in CASES.values())]
    assert counts == [2, 6, 1, 1, 2, 2]


def test_parts_are_counted_in_their_stages(monkeypatch):
    played, play = [], Plant.play
    monkeypatch.setattr(Plant, "play", lambda *arguments: played.append(1) or play(*arguments))
    with counting() as stages:
        diagnose(*small(), jobs=1)
    calls = [calls for calls, _ in stages.parts.values()]
    assert sum(c["replay"] + c["replay of initial state"] for c in calls) == len(played)
    assert all(sum(c[part] for c in calls) for part in PARTS)
    assert {"prepare", "inspect", "constants", "screen", "conclude", "detection limits"} <= set(stages.parts)
    assert set(stages.parts) <= {*STAGES, "rest"}


def test_tasks_of_other_processes_are_counted():
    counts = []
    for jobs in (1, 2):
        with counting() as stages:
            diagnose(*small(), jobs=jobs)
        counts.append(sum(calls["residual"] for calls, _ in stages.parts.values()))
    assert counts[0] == counts[1] > 0


def test_a_run_is_stored_beside_the_others_and_compared(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(measure, "CASES", {"first": Case("some", ("coulomb",), small), "second": Case("some", ("x",), small)})
    monkeypatch.setattr(measure, "_compile", lambda jobs: None)
    said = []
    both = measure.measure(said.append, jobs=1, folder=tmp_path)
    assert set(both) == {"some_median_s", "some_longest_s"}
    stored = json.loads((tmp_path / "diagnosis.json").read_text())["cases"]
    assert stored["first"]["effects"] == ["coulomb"]
    assert measure.measure(said.append, ["second"], jobs=1, folder=tmp_path) == {}
    again = json.loads((tmp_path / "diagnosis.json").read_text())["cases"]
    assert again["first"] == stored["first"]
    assert f"before {stored['second']['seconds']:.1f} s" in said[-1]
    assert (tmp_path / "diagnosis.md").read_text() == table.markdown(again)
    assert "wall s" in capsys.readouterr().out
