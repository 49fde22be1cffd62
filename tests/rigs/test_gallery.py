"""The gallery: answers, pictures and pages of rigs, on simulated ones."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from cli_stand_ins import Call

from flexarm_env import Arm, Recording, simulate
from flexarm_env.errors import InputError
from flexarm_env.rigs import gallery, table
from flexarm_env.rigs.document import document
from flexarm_env.rigs.examine import pose
from flexarm_env.rigs.metric import SignalFit
from flexarm_env.rigs.rig import Published, Record, Rig

BENCH = Rig(
    name="bench",
    title="a bench",
    source="simulated",
    arm="cu-rigid",
    training=(Record("bench/one.csv"),),
    held_out=(Record("bench/two.csv", "the other"),),
    metric=SignalFit(),
    published=(Published("Coulomb friction", 97.0),),
    goal=95.0,
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("measurements")
    (place / "bench").mkdir()
    machine = Arm.load("cu-rigid").with_effect("coulomb", torque=0.05)
    for name, seed in (("one", 1), ("two", 2)):
        simulate(machine, "square", duration=3.0, rate=100.0, seed=seed).write(place / "bench" / f"{name}.csv")
    return place


def _read(record: Record, folder: Path, _: Arm) -> Recording:
    return replace(Recording.read(folder / record.file), name=record.name or "one")


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch, folder: Path) -> Path:
    """The folder of the only rig; its files have FlexArm's own header."""
    monkeypatch.setattr(gallery, "RIGS", (BENCH,))
    monkeypatch.setattr(Record, "read", _read)
    return folder


def test_a_rig_is_diagnosed_once_and_judged_on_what_was_not_fitted(bench, tmp_path, capsys):
    flexarm, output = Call(capsys), tmp_path / "rigs"
    assert flexarm("rigs", bench, "--output", output, "--jobs", 1) == 0
    assert flexarm.err.splitlines()[-1].startswith("bench: missing coulomb; held out ")
    assert sorted(path.name for path in output.iterdir()) == [
        *(f"bench.{suffix}" for suffix in ("json", "png", "toml")),
        "rigs.json",
        "rigs.md",
    ]
    answer = json.loads((output / "bench.json").read_text())
    assert answer["diagnosis"]["effects"] == ["coulomb"]
    assert answer["reached"]
    assert answer["figures"]["nominal"] < 95.0 < answer["figures"]["final"]
    corrected = Arm.load(output / "bench.toml")
    assert answer["figures"]["final"] == BENCH.metric.of(corrected, pose(BENCH, bench).held_out)
    written = (output / "rigs.md").read_text()
    assert written == document([answer])
    assert "| [a bench](#bench) | fit of arm angle, one free run |" in written
    before = (output / "bench.json").stat().st_mtime_ns
    assert flexarm("rigs", bench, "--output", output, "--jobs", 1) == 0
    assert flexarm.err.splitlines()[-1].endswith("kept from before")
    assert (output / "bench.json").stat().st_mtime_ns == before


def test_an_answer_is_kept_only_for_the_same_arm_recordings_and_rig(bench, tmp_path):
    posed = pose(BENCH, bench)
    answer = {"key": posed.key}
    (tmp_path / "bench.json").write_text(json.dumps(answer))
    assert gallery.stored(tmp_path, posed) == answer
    for other in (
        replace(posed, arm=posed.arm.with_values({"hub.inertia": 0.004})),
        replace(posed, held_out=[replace(posed.held_out[0], sha256="0")]),
        replace(posed, rig=replace(BENCH, metric=SignalFit(closed=True))),
    ):
        assert gallery.stored(tmp_path, other) is None
    for damaged in ("", "{", "[]", '{"key": 3}'):
        (tmp_path / "bench.json").write_text(damaged)
        assert gallery.stored(tmp_path, posed) is None


def test_a_run_that_stops_resumes_at_the_rig_without_an_answer(bench, tmp_path, monkeypatch):
    examined = []

    def answer(posed, output, jobs, progress):
        if len(examined) == 1:
            raise KeyboardInterrupt
        examined.append(posed.rig.name)
        found = {"key": posed.key, "rig": posed.rig.name}
        (output / f"{posed.rig.name}.json").write_text(json.dumps(found))
        return found

    monkeypatch.setattr(gallery, "_answer", answer)
    rigs = [BENCH, replace(BENCH, name="second")]
    with pytest.raises(KeyboardInterrupt):
        gallery.run(rigs, bench, tmp_path)
    examined.clear()
    assert [one["rig"] for one in gallery.run(rigs, bench, tmp_path)] == ["bench", "second"]
    assert examined == ["second"]


def test_an_unknown_rig_and_a_folder_without_recordings_are_refused(bench, tmp_path, capsys):
    flexarm = Call(capsys)
    assert flexarm("rigs", bench, "--only", "none", "--output", tmp_path / "rigs") == 2
    assert "unknown rig 'none'; there are bench" in flexarm.err
    assert flexarm("rigs", tmp_path, "--output", tmp_path / "rigs") == 2
    assert "has the recordings of no rig; name the folder in which bench/one.csv lies" in flexarm.err
    assert not (tmp_path / "rigs").exists()
    with pytest.raises(InputError, match="unknown rig"):
        gallery.rigs_in(bench, ["emps"])
    with pytest.raises(InputError, match=r"lacks bench/one\.csv of rig 'bench'; put it there, or leave the rig out"):
        gallery.rigs_in(tmp_path, ["bench"])


def test_goals_are_reached_from_either_side():
    assert BENCH.reaches_goal(95.0)
    assert not BENCH.reaches_goal(94.0)
    assert not replace(BENCH, goal=None).reaches_goal(99.0)
    emps = next(rig for rig in table.RIGS if rig.name == "emps")
    assert emps.reaches_goal(5.3)
    assert not emps.reaches_goal(5.4)


def test_every_rig_is_read_where_it_lies(measurements):
    for rig in table.RIGS:
        assert rig.is_in(measurements)
        posed = pose(rig, measurements)
        assert all(run.input_kind == posed.arm.input for run in (*posed.training, *posed.held_out))
        assert not {run.name for run in posed.training} & {run.name for run in posed.held_out}
    assert len({rig.name for rig in table.RIGS}) == len(table.RIGS)


def test_the_parts_and_cells_of_a_file_are_the_right_ones(measurements):
    ur10e, swing = (next(rig for rig in table.RIGS if rig.name == name) for name in ("ur10e", "multiarm"))
    posed = pose(ur10e, measurements)
    second, first = posed.training[0], posed.held_out[0]
    assert second.conditions["start"] == pytest.approx(first.duration + first.sample_time, abs=0.02)
    posed = pose(swing, measurements)
    assert [run.name for run in posed.training] == ["id 1", "id 2", "id 3", "id 4"]
    assert [round(float(run.signals["arm_angle"][0]), 3) for run in posed.held_out] == [3.568, 2.854]
