"""Conditions of recordings that take the place of an arm's constants."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, compare, fit, simulate
from flexarm_env.control.law import ControlLaw, Feedback
from flexarm_env.errors import InputError
from flexarm_env.experiments.stated import check_stated, stated_by, with_stated
from flexarm_env.identify.calibrate.parameters import free_parameters
from flexarm_env.identify.replay.dataset import prepare

INERTIA = "hub.inertia"


def rigid() -> Arm:
    return replace(Arm.load("cu-rigid").with_effect("viscous", coefficient=0.02), conditions={"load": INERTIA})


def loaded(arm: Arm, name: str, factor: float, **more: float) -> Recording:
    """A run of the arm with another inertia, which it states."""
    value = factor * arm.value(INERTIA)
    run = simulate(arm.with_values({INERTIA: value}), "pulse", duration=3.0, rate=200.0, noise=False, name=name, seed=1)
    return replace(run, conditions={"load": value, **more})


def test_each_recording_is_replayed_with_its_own_value():
    arm = rigid()
    runs = [loaded(arm, "light", 1.0), loaded(arm, "heavy", 3.0)]
    assert compare(arm, runs).free_run < 1e-6
    assert compare(replace(arm, conditions={}), runs).free_run > 10.0
    notes = compare(arm, runs).notes
    assert f"heavy: hub.inertia is {3 * arm.value(INERTIA):g} kg*m**2, as the recording states" in notes


def test_commands_are_played_with_the_conditions_of_their_recording():
    arm = rigid()
    heavy = loaded(arm, "heavy", 3.0, trial=7.0)
    played = simulate(arm, heavy, noise=False)
    np.testing.assert_allclose(played.signals["arm_angle"], heavy.signals["arm_angle"], atol=1e-12)
    assert played.conditions == {"load": heavy.conditions["load"]}


def test_a_constant_that_every_recording_states_is_not_fitted():
    arm = rigid()
    light, heavy = loaded(arm, "light", 1.0), loaded(arm, "heavy", 3.0)
    dataset = prepare(arm, [light, heavy])[1]
    assert INERTIA not in [one.path for one in free_parameters(arm, arm, dataset)]
    some = prepare(arm, [replace(light, conditions={}), heavy])[1]
    assert INERTIA in [one.path for one in free_parameters(arm, arm, some)]


def test_the_others_are_fitted_over_recordings_that_differ():
    arm = rigid()
    runs = [loaded(arm, "light", 1.0), loaded(arm, "heavy", 3.0)]
    wrong = arm.with_values({"effects.viscous.coefficient": 0.026})
    found = fit(wrong, runs, jobs=1)
    assert found.arm.value("effects.viscous.coefficient") == pytest.approx(0.02, rel=0.01)
    assert found.arm.value(INERTIA) == arm.value(INERTIA)
    assert found.arm.conditions == arm.conditions


def test_an_arm_file_keeps_them(tmp_path):
    arm = rigid()
    arm.save(tmp_path / "a.toml")
    assert Arm.load(tmp_path / "a.toml") == arm


def test_a_payload_adds_to_the_arm_and_a_value_replaces_its_own():
    arm = replace(Arm.load("thesis"), conditions={"rotor": "drive.motor_inertia"})
    run = replace(simulate(arm, "pulse", duration=1.0, rate=100.0), conditions={"payload": 0.2, "rotor": 0.001, "trial": 2.0})
    stated = stated_by(arm, run)
    assert stated == (("drive.motor_inertia", 0.001), ("payload", 0.2))
    found = with_stated(arm.with_effect("payload", mass=0.1), stated)
    assert found.value("effects.payload.mass") == pytest.approx(0.3)
    assert found.value("drive.motor_inertia") == 0.001


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('load = "hub.inertai"', "conditions.load: unknown constant 'hub.inertai'"),
        ('load = "effects.viscous.coefficient"', "conditions.load: unknown constant"),
        ("load = 3", "conditions.load: unknown constant 3"),
        ('a = "hub.inertia"\nb = "hub.inertia"', "conditions.b: another condition sets 'hub.inertia'"),
        ('payload = "hub.inertia"', "conditions.payload: every arm takes up 'payload' as it is"),
    ],
)
def test_a_wrong_condition_is_refused(tmp_path, line, words):
    path = tmp_path / "a.toml"
    Arm.load("cu-rigid").save(path)
    path.write_text(f"{path.read_text()}\n[conditions]\n{line}\n")
    with pytest.raises(InputError) as caught:
        Arm.load(path)
    assert words in str(caught.value)


def test_a_value_out_of_bounds_is_refused():
    arm = rigid()
    with pytest.raises(InputError, match=r"heavy: the stated hub\.inertia = -1 kg\*m\*\*2 is out of bounds"):
        compare(arm, [replace(loaded(arm, "heavy", 3.0), conditions={"load": -1.0})])


def test_a_value_with_which_there_is_no_such_arm_is_refused():
    arm = replace(rigid(), conditions={"ohm": "drive.resistance"})
    run = replace(loaded(rigid(), "cold", 3.0), conditions={"ohm": 0.0})
    with pytest.raises(InputError, match=r"cold states drive\.resistance = 0: drive\.resistance is missing or below 1e-06 ohm"):
        check_stated(arm, run)


HEADER = "time [s],current [A],arm_angle [rad]\n0,0,0\n0.1,1,0\n0.2,1,0.01\n"


def read_stating(tmp_path, text: str, where: str) -> Recording:
    """A recording that states the load in a remark, in a file beside it, or in a column."""
    path = tmp_path / "run.csv"
    path.write_text(f"# load = {text}\n{HEADER}" if where == "remark" else HEADER)
    if where == "sidecar":
        (tmp_path / "run.toml").write_text(f"[conditions]\nload = '{text}'\n")
    if where != "column":
        return Recording.read(path)
    number, _, unit = text.partition(" ")
    places = {"time": (0, "s"), "current": (1, "A"), "arm_angle": (2, "rad"), "load": (3, unit)}
    path.write_text("\n".join(f"{line},{number}" for line in HEADER.splitlines()[1:]) + "\n")
    columns = {name: {"index": index, "unit": unit} for name, (index, unit) in places.items()}
    return Recording.read(path, columns | {"conditions": {"load": columns.pop("load")}})


@pytest.mark.parametrize("where", ["remark", "sidecar", "column"])
def test_a_condition_in_a_unit_of_another_quantity_is_refused(tmp_path, where):
    with pytest.raises(InputError) as refusal:
        check_stated(rigid(), read_stating(tmp_path, "300 g", where))
    expected = "run: condition 'load' is 0.3 kg, and sets hub.inertia: unit 'kg' does not convert to kg*m**2"
    assert str(refusal.value) == f"{expected}; write a unit that converts to kg*m**2"


@pytest.mark.parametrize("where", ["remark", "sidecar", "column"])
def test_a_condition_in_another_unit_of_the_same_quantity_is_taken(tmp_path, where):
    arm, run = rigid(), read_stating(tmp_path, "300 g*m^2", where)
    check_stated(arm, run)
    assert stated_by(arm, run) == ((INERTIA, pytest.approx(0.3, rel=1e-12)),)
    run.write(tmp_path / "again.csv")
    again = Recording.read(tmp_path / "again.csv")
    check_stated(arm, again)
    assert again.conditions == run.conditions
    with pytest.raises(InputError, match=r"hub\.inertia"):
        check_stated(arm, replace(again, conditions=read_stating(tmp_path, "300 g", where).conditions))


def test_a_condition_without_a_unit_is_in_that_of_its_constant(tmp_path):
    check_stated(rigid(), read_stating(tmp_path, "0.3", "remark"))


def test_a_condition_that_the_arm_takes_up_and_that_cannot_be_read_is_refused(tmp_path):
    """Another is a note alone, and one that a file beside the recording states is known."""
    run = read_stating(tmp_path, "0,3", "remark")
    with pytest.raises(InputError) as refusal:
        check_stated(rigid(), run)
    note = f"{tmp_path / 'run.csv'}: row 1: 'load = 0,3' is read as a remark: it has a decimal comma; write a point"
    assert str(refusal.value) == f"{note}; arm 'cu-rigid' takes up 'load', so correct the line"
    check_stated(replace(rigid(), conditions={}), run)
    (tmp_path / "run.toml").write_text("[conditions]\nload = '0.3 kg*m^2'\n")
    check_stated(rigid(), Recording.read(tmp_path / "run.csv"))


def test_so_is_one_that_a_control_law_names(tmp_path):
    law = ControlLaw((Feedback("arm_angle", ("load",)),))
    run = read_stating(tmp_path, "0,3", "remark")
    with pytest.raises(InputError, match="takes up 'load', so correct the line"):
        check_stated(replace(rigid(), conditions={}), replace(run, controller=law))
