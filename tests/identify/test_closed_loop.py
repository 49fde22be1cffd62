"""Replays in closed loop: against simulated loops, and real machines under their recorded laws."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, compare, simulate
from flexarm_env.control.law import ControlLaw, Feedback
from flexarm_env.experiments.rig import SpeedEstimate
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import closed_loop_errors, score
from flexarm_env.identify.replay.loop import Loop, compare_commands, law_commands
from flexarm_env.pictures.page import Findings, page
from flexarm_env.plant.plant import NO_GAINS, NO_INTERVALS, NOT_MEASURED
from flexarm_env.terminal import plain_data, tables
from flexarm_env.terminal.inputs import read_recordings
from flexarm_env.thesis_drive import DERIVATIVE, GEAR_RATIO, PROPORTIONAL
from flexarm_env.units import base_value

#: The law of simulated experiments on the thesis's arm, which is fed with noisy readings in steps of the sensor.
PD = ControlLaw((Feedback("arm_angle", (PROPORTIONAL,)), Feedback("motor_speed", (DERIVATIVE,))))
#: Without a tachometer, they take the speed from the angle.
SLOPE = ControlLaw((Feedback("arm_angle", (PROPORTIONAL,), derivative=(DERIVATIVE * GEAR_RATIO,), derivative_filter=0.02),))


def thesis(law: ControlLaw | None, **effects: dict[str, float]) -> Arm:
    arm = replace(Arm.load("thesis"), controller=law)
    for name, values in effects.items():
        arm = arm.with_effect(name, **values)
    return arm


def loop_run(arm: Arm, rate: float, held: int, law: Callable[[float, np.ndarray], float]) -> Recording:
    """Run an arm under a law of reference and readings; the plant moves by a whole period of the controller at once."""
    plant = arm.plant(1.0 / rate)
    plant.place()
    count = round(6.0 * rate / held) * held
    reference = np.where(np.arange(count) / rate % 4.0 > 2.0, -0.8, 0.8) * (np.arange(count) > 0.5 * rate)
    readings, commands = np.zeros((count, len(plant.signals))), np.zeros(count)
    row = np.zeros(len(plant.signals))
    for k in range(0, count, held):
        commands[k : k + held] = law(reference[k], row)
        played = plant.play(np.full(held + 1, commands[k]), NO_INTERVALS, NO_GAINS, NOT_MEASURED)
        readings[k : k + held], row = played[:-1], played[-1]
    signals = dict(zip(plant.signals, readings.T, strict=True))
    return Recording.from_arrays("run", np.arange(count) / rate, "current", commands, signals, reference)


@pytest.mark.parametrize(
    "effects",
    [
        {},
        {"input_delay": {"delay": 0.012}},
        {"time_offset": {"offset": -0.013}},
        {"saturation": {"limit": 1.5}},
    ],
    ids=lambda effects: next(iter(effects), "plain"),
)
def test_a_simulated_loop_is_replayed_to_rounding(effects):
    arm = thesis(PD, **effects)
    found = compare(arm, [simulate(arm, "square", duration=4.0, rate=200.0, noise=False)])
    assert [row.quantity for row in found.loop_rows] == [*arm.signals, "current"]
    assert max(row.relative for row in found.loop_rows) < 1e-6
    assert found.closed_loop < 1e-6


def test_a_loop_on_the_slope_of_the_angle_is_replayed_to_rounding():
    arm = thesis(SLOPE)
    arm = replace(arm, sensors={"arm_angle": arm.sensors["arm_angle"]})
    estimate = SpeedEstimate(arm, 200.0)

    def pd(reference: float, row: np.ndarray) -> float:
        angle, speed = estimate.read(row)
        return min(max(PROPORTIONAL * (reference - angle) - DERIVATIVE * speed, -5.0), 5.0)

    found = compare(arm, [loop_run(arm, 200.0, 1, pd)])
    assert max(row.relative for row in found.loop_rows) < 1e-6


def test_a_controller_slower_than_the_recording_is_replayed_to_rounding():
    arm = thesis(replace(PD, rate=100.0, limit=3.0))

    def pd(reference: float, row: np.ndarray) -> float:
        return min(max(PROPORTIONAL * (reference - row[0]) - DERIVATIVE * row[1], -3.0), 3.0)

    recording = loop_run(arm, 500.0, 5, pd)
    found = compare(arm, [recording])
    assert max(row.relative for row in found.loop_rows) < 1e-6
    too_fast = compare(replace(arm, controller=replace(PD, limit=3.0)), [recording])
    assert too_fast.loop_rows[0].relative > 0.1


def test_uneven_samples_are_replayed_in_closed_loop():
    arm = thesis(PD)
    run = simulate(arm, "square", duration=4.0, rate=200.0, noise=False)
    kept = np.flatnonzero(np.random.default_rng(1).random(len(run)) > 0.05)
    signals = {name: values[kept] for name, values in run.signals.items()}
    some = Recording.from_arrays("some", run.time[kept], "current", run.command[kept], signals, run.reference[kept])
    angle = compare(arm, [some]).loop_rows[0]
    assert 1e-8 < angle.relative < 5.0


def test_noise_is_left_to_the_scale_of_the_errors():
    arm = thesis(PD)
    run = simulate(arm, "square", duration=6.0, rate=200.0, seed=3)
    found = compare(arm, [run])
    assert found.closed_loop < 1.2 * found.free_run
    assert compare(arm, [run]).loop_rows[:-1] == found.loop_rows[:-1]


def test_the_law_is_checked_against_the_recorded_command():
    arm = thesis(PD)
    run = simulate(arm, "square", duration=4.0, rate=200.0, noise=False)
    assert any("misses the recorded current by" in note for note in compare(arm, [run]).notes)
    loop = prepare(arm, [run])[1].runs[0].loop
    assert loop.law_error < 1e-12
    assert abs(loop.lag) < 0.05 / 200.0
    weaker = thesis(replace(PD, feedback=(replace(PD.feedback[0], proportional=(0.9 * PROPORTIONAL,)), PD.feedback[1])))
    loop = prepare(weaker, [run])[1].runs[0].loop
    missing = 0.1 * PROPORTIONAL * (run.reference - run.signals["arm_angle"])
    assert loop.law_error == pytest.approx(np.linalg.norm(missing) / np.linalg.norm(run.command), rel=1e-9)


def test_a_lag_of_the_recorded_command_is_found():
    arm = thesis(PD)
    run = simulate(arm, "square", duration=4.0, rate=200.0, noise=False)
    late = replace(run, command=np.concatenate([np.zeros(3), run.command[:-3]]))
    prompt, found = (prepare(arm, [one])[1].runs[0] for one in (run, late))
    assert "later" not in prompt.loop_note
    assert found.loop.lag == pytest.approx(0.015, abs=0.0005)
    assert found.loop.late_error < 1e-3 < found.loop.law_error
    assert found.loop_note.endswith("where it comes 15 ms later")


@pytest.mark.parametrize("lag", [-4.6, 0.0, 2.0, 7.3])
def test_a_part_of_a_sample_is_found(lag):
    def command(time):
        return np.sin(0.05 * time) + 0.4 * np.cos(0.13 * time)

    time = np.arange(1000.0)
    error, found, late = compare_commands(command(time - lag), command(time), 20)
    assert found == pytest.approx(lag, abs=0.02)
    assert late <= error + 1e-12


def test_the_law_holds_a_reading_that_is_absent():
    angle = np.array([[np.nan], [1.0], [np.nan], [np.nan], [4.0]])
    loop = Loop(ControlLaw((Feedback("arm_angle", (2.0,)),)), (0,), np.zeros(5))
    assert law_commands(loop, angle, 0.0, 0.01, 0.0).tolist() == [-2.0, -2.0, -2.0, -2.0, -8.0]


def test_another_law_is_not_taken_for_that_of_the_recording():
    run = simulate(thesis(PD), "square", duration=4.0, rate=200.0)
    wrong = thesis(ControlLaw((Feedback("arm_angle", (3.0 * PROPORTIONAL,)),)))
    found, bare = compare(wrong, [run]), compare(thesis(None), [run])
    assert found.closed_loop is None
    assert found.loop_rows == []
    assert (found.error, found.free_run) == (bare.error, bare.free_run)
    assert "is not that of the recording" in found.notes[0]


def test_what_the_law_needs_and_the_recording_lacks_is_named():
    arm = thesis(ControlLaw((Feedback("arm_angle", ("K1",)), Feedback("motor_speed", (DERIVATIVE,)))))
    run = simulate(arm, "square", duration=2.0, rate=200.0)
    assert "the control law needs K1, a line such as '# K1 = 1' each" in compare(arm, [run]).notes[0]
    assert compare(arm, [replace(run, conditions={"K1": PROPORTIONAL})]).closed_loop is not None
    silent = replace(run, signals={"arm_angle": run.signals["arm_angle"]}, conditions={"K1": PROPORTIONAL})
    assert "the control law needs motor_speed," in compare(arm, [silent]).notes[0]


@pytest.mark.parametrize(
    ("stated", "is_replayed", "is_named"),
    [
        (f"{PROPORTIONAL} A/rad", True, False),
        (f"{PROPORTIONAL} V/rad", True, False),  # the recorded command tells that the number is right
        (f"{3 * PROPORTIONAL} V/rad", False, True),
        (f"{PROPORTIONAL} A/deg", False, False),
    ],
)
def test_the_unit_of_a_stated_gain_is_named_where_the_law_fails(stated, is_replayed, is_named):
    arm = thesis(ControlLaw((Feedback("arm_angle", ("K1",)), Feedback("motor_speed", (DERIVATIVE,)))))
    run = replace(simulate(arm, "square", duration=2.0, rate=200.0), conditions={"K1": base_value(stated)})
    found = compare(arm, [run])
    assert (found.closed_loop is not None) == is_replayed
    words = f"is a unit wrong? K1 = {3 * PROPORTIONAL:g} V/rad is controller.arm_angle.proportional, which is in A/rad"
    assert any(words in note for note in found.notes) == is_named


def test_a_recording_without_a_reference_is_replayed_under_its_command():
    arm = thesis(PD)
    run = simulate(arm, "pulse", duration=2.0, rate=200.0)
    found = compare(arm, [run])
    assert run.reference is None
    assert found.closed_loop is None
    assert found.notes == []


def test_the_law_of_a_column_map_goes_before_that_of_the_arm(tmp_path):
    run = simulate(thesis(None), "square", duration=2.0, rate=200.0, noise=False)
    run.write(tmp_path / "run.csv")
    entries = [
        ("time", "s"),
        ("current", "A"),
        ("reference", "rad"),
        *[(s, "rad" if s == "arm_angle" else "rad/s") for s in PD.signals],
    ]
    lines = ["[columns]", *(f'{name} = {{ column = "{name} [{unit}]", unit = "{unit}" }}' for name, unit in entries)]
    lines += [f"[controller.arm_angle]\nproportional = {PROPORTIONAL}", f"[controller.motor_speed]\nproportional = {DERIVATIVE}"]
    (tmp_path / "map.toml").write_text("\n".join(lines))
    wrong = thesis(ControlLaw((Feedback("arm_angle", (20.0,)),)))
    read = Recording.read(tmp_path / "run.csv", columns=tmp_path / "map.toml")
    assert read.controller == PD
    assert prepare(wrong, [read])[1].runs[0].loop.law_error < 1e-12
    assert prepare(wrong, [run])[1].runs[0].loop is None


def test_scores_hold_both_only_where_the_loop_is_known():
    machine = thesis(None, coulomb={"torque": 0.35})
    run = simulate(machine, "square", duration=4.0, rate=200.0)
    arm, dataset = prepare(thesis(PD), [run])
    known, bare = score(arm, dataset), score(*prepare(thesis(None), [run]))
    assert (known.windows, known.free_run) == (bare.windows, bare.free_run)
    assert closed_loop_errors({"given": thesis(None)}, prepare(thesis(None), [run])[1]) == {}
    (closed,) = closed_loop_errors({"given": arm}, dataset).values()
    assert closed != known.free_run


def test_results_as_plain_data_have_both():
    arm = thesis(PD)
    data = plain_data.of_comparison(compare(arm, [simulate(arm, "square", duration=2.0, rate=200.0)]))
    assert list(data)[:3] == ["error", "free_run", "closed_loop"]
    assert {row["quantity"] for row in data["loop_rows"]} == {*arm.signals, "current"}


def test_tables_and_report_show_the_errors_in_closed_loop():
    arm = thesis(PD)
    run = simulate(arm, "square", duration=2.0, rate=200.0)
    found, bare = compare(arm, [run]), compare(thesis(None), [run])
    shown = [
        part for part in tables.comparison(found) if getattr(part, "title", None) == "In closed loop, by the stated control law"
    ]
    assert [str(cell) for cell in shown[0].columns[1].cells][-1] == "current"
    assert not [part for part in tables.comparison(bare) if "closed" in str(getattr(part, "title", None))]
    assert "In closed loop" in page(Findings(found, [run]))
    assert "In closed loop" not in page(Findings(bare, [run]))


def loops(arm: Arm, files: list) -> dict[tuple[str, str], object]:
    found = compare(arm, read_recordings(arm, files, None))
    return {(row.recording, row.quantity): row for row in found.loop_rows}


def test_emps_follows_its_law(measurements):
    """Against an independent simulation of the published model: position 0.00109 %, force 4.57 %."""
    arm = Arm.load("emps")
    files = [measurements / "emps" / "DATA_EMPS.mat"]
    run = prepare(arm, read_recordings(arm, files, None))[1].runs[0]
    assert run.loop.law_error < 0.003
    assert abs(run.loop.lag) < 0.0001
    rows = loops(arm, files)
    assert rows["DATA_EMPS", "arm_angle"].relative <= 0.001095
    assert rows["DATA_EMPS", "current"].relative <= 4.57


def test_asymmetric_friction_improves_emps_in_closed_loop(measurements):
    """With the published constants of the asymmetric model."""
    values = {"hub.inertia": 95.154, "effects.viscous.coefficient": (166.7061 + 240.4236) / 2}
    values |= {"effects.coulomb.torque": (20.144 + 20.6277) / 2, "effects.constant_torque.torque": (20.6277 - 20.144) / 2}
    arm = Arm.load("emps").with_values(values).with_effect("asymmetric_viscous", coefficient=(166.7061 - 240.4236) / 2)
    rows = loops(arm, [measurements / "emps" / "DATA_EMPS.mat"])
    assert rows["DATA_EMPS", "arm_angle"].relative < 0.00085
    assert rows["DATA_EMPS", "current"].relative < 3.75


@pytest.mark.parametrize(
    ("name", "run", "fit"), [("cu-rigid", "rigidarm_K1_6", 28.0), ("cu-flexible", "flexarm_K1K2_6_-5", -0.5)]
)
def test_cu_boulder_fits_as_an_independent_study_found(measurements, name, run, fit):
    """The handout's models, as given, in closed loop."""
    file = measurements / "cu_boulder" / f"BenHagenau_{run}.txt"
    row = loops(Arm.load(name), [file])[file.stem, "arm_angle"]
    assert row.fit == pytest.approx(fit, abs=1.0)


def test_the_laws_of_cu_boulder_give_the_recorded_voltage(measurements):
    for name, kind in (("cu-rigid", "rigidarm"), ("cu-flexible", "flexarm")):
        arm = Arm.load(name)
        files = sorted((measurements / "cu_boulder").glob(f"BenHagenau_{kind}_*.txt"))
        runs = prepare(arm, read_recordings(arm, files, None))[1].runs
        assert [run.loop.law_error < (0.17 if "k1k3" in run.name else 0.027) for run in runs] == [True] * 3
