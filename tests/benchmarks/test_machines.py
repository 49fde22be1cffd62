"""The benchmark of machines: cases are determined by seed and index, effects show, answers are scored by their kind's goal."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from benchmarks.answers.run import run
from benchmarks.machines import table
from benchmarks.machines.cases import KINDS, Key, case, keys
from benchmarks.machines.catalogue import CATALOGUE, PLANT
from benchmarks.machines.effects import Sized, draw_details
from benchmarks.machines.experiments import Run, runs
from benchmarks.machines.families import FAMILIES
from benchmarks.machines.lacks import COUNTS, fit_together, possible
from benchmarks.machines.machine import settings
from benchmarks.machines.method import by_diagnosis_or_failure
from benchmarks.machines.outside import OUTSIDE
from benchmarks.machines.score import figures, intervals, is_honest, is_solved
from benchmarks.machines.spread import drawn, spreads, with_values
from benchmarks.machines.strength import Yardstick, carried_on, find_size
from benchmarks.machines.twins import twins
from flexarm_env import Arm
from tests.rig import Plan

#: A place of each kind among the first cases.
PLACES = {kind: KINDS.index(kind) for kind in COUNTS}


def test_a_case_is_determined_by_its_seed_and_its_index():
    one, again = case(3, PLACES["null"]), case(3, PLACES["null"])
    other = case(4, PLACES["null"])
    assert one.as_json() == again.as_json()
    assert one.arm == again.arm
    for first, second in zip(one.recordings, again.recordings, strict=True):
        assert np.array_equal(first.command, second.command)
        assert all(np.array_equal(first.signals[name], second.signals[name]) for name in first.signals)
    assert one.as_json() != other.as_json()
    assert json.loads(json.dumps(one.as_json())) == one.as_json()


def test_what_is_known_before_a_case_is_made_stands_in_its_answer():
    key = Key(3, PLACES["null"])
    posed, arm, recordings = key.pose()
    assert posed.items() >= key.as_json().items()
    assert arm.signals == list(recordings[0].signals)


def test_kinds_are_mixed_and_can_be_chosen():
    assert {key.kind for key in keys(1, len(KINDS))} == set(COUNTS)
    twos = keys(1, 5, "two")
    assert [key.kind for key in twos] == ["two"] * 5
    assert set(twos) <= set(keys(1, 5 * len(KINDS)))


@pytest.mark.parametrize("family", FAMILIES)
def test_a_family_is_within_its_ranges(family):
    torques, frequencies = [], []
    for seed in range(60):
        draw = np.random.default_rng([seed, 1])
        model = FAMILIES[family](draw)
        torques.append(model.torque)
        frequencies.append(model.clamped / math.tau)
        planned = runs(draw, model)
        assert 1 <= len(planned) <= 3
        assert all(100.0 <= one.rate <= 1000.0 and 4.9 <= len(one.plan.feed) / one.rate <= 10.1 for one in planned)
        if model.rotary:
            counts = math.tau / model.values["sensors.arm_angle.resolution"]
            assert 1999.0 < counts < 16385.0
    low, high = (1.0, 1000.0) if family == "screw" else (0.01, 10.0)
    assert low < min(torques) < 4.0 * low
    assert high / 4.0 < max(torques) < high
    flexible = family.startswith("flexible")
    assert (0.2 < min(frequencies) < 0.4 and 5.0 < max(frequencies) < 10.0) if flexible else not any(frequencies)


def test_a_machine_differs_from_its_model_within_the_priors():
    for seed in range(20):
        draw = np.random.default_rng(seed)
        model = FAMILIES[list(FAMILIES)[seed % len(FAMILIES)]](draw)
        machine = drawn(draw, model)
        moved = {path for path, value in machine.values.items() if value != model.values[path]}
        assert moved - {"effects.base_tilt.torque", "effects.base_tilt.uphill"} == set(spreads(model))
        for path, spread in spreads(model).items():
            assert abs(math.log(machine.values[path] / model.values[path])) < 2.0 * spread
        assert moved.isdisjoint(model.arm.fixed)


def test_an_effect_is_as_strong_as_wanted_and_grows_with_its_size():
    draw = np.random.default_rng(5)
    machine = drawn(draw, FAMILIES["rigid_current"](draw))
    yard = Yardstick(machine, runs(draw, machine)[:1])
    hidden = CATALOGUE["constant_torque"]
    one = Sized("constant_torque", hidden, hidden.largest(machine), draw_details(draw, hidden, machine))
    found = find_size(yard, one, 10.0)
    assert found.strength == pytest.approx(10.0, rel=0.2)
    twice = Sized("constant_torque", hidden, 2.0 * found.size)
    assert yard.left(yard.signature(twice)) > 1.5 * found.strength
    assert find_size(yard, one, 1e9) is None


@pytest.mark.parametrize("seed", [2, 3])
def test_a_cable_that_a_heavier_link_makes_up_for_leaves_less_than_slopes_foretell(seed):
    draw = np.random.default_rng(seed)
    machine = drawn(draw, FAMILIES["vertical"](draw))
    yard = Yardstick(machine, runs(draw, machine)[:1])
    hidden = CATALOGUE["cable_stiffness"]
    one = Sized("cable_stiffness", hidden, 0.2 * hidden.largest(machine), draw_details(draw, hidden, machine))
    assert yard.strength(one) > 5.0
    assert yard.refitted(one) < 0.6


def test_a_constant_that_is_off_within_its_prior_leaves_nothing():
    draw = np.random.default_rng(6)
    machine = drawn(draw, FAMILIES["rigid_current"](draw))
    yard = Yardstick(machine, runs(draw, machine)[:1])
    own = 0.5 * yard.columns[:, 0]
    assert np.sqrt(np.mean(own**2)) > 10.0
    assert yard.left(own) < 0.05
    assert yard.left(own, [own]) < 1e-6


def test_a_hub_left_to_itself_swings_by_its_weight_and_coasts_against_its_motor():
    def free(family, drive):
        models = (FAMILIES[family](np.random.default_rng(seed)) for seed in range(99))
        return next(m for m in models if m.arm.input == drive and "viscous" not in m.arm.effects)

    link = free("vertical", "current")
    pulse = math.sqrt(link.values["effects.base_tilt.torque"] / link.inertia)
    time = np.arange(100) / 100.0
    swing = carried_on(link, 100, 100.0)
    np.testing.assert_allclose(swing[:, 0, 0], np.cos(pulse * time), atol=1e-9)
    np.testing.assert_allclose(swing[:, 0, 1], np.sin(pulse * time) / pulse, atol=1e-9)
    axis = free("rigid_voltage", "voltage")
    drive = axis.values
    own = (drive["drive.gear_ratio"] * drive["drive.torque_constant"]) ** 2 / drive["drive.resistance"]
    np.testing.assert_allclose(carried_on(axis, 100, 100.0)[:, 1, 1], np.exp(-own / axis.inertia * time), atol=1e-9)


def test_effects_of_one_part_are_not_drawn_together():
    assert not fit_together(["dead_zone", "saturation"])
    assert not fit_together(["time_offset", "input_delay"])
    assert not fit_together(["backlash", "coulomb"])
    assert fit_together(["dead_zone", "cable_stiffness"])


@pytest.mark.parametrize("family", ["rigid_torque", "elastic_joint"])
def test_several_kinds_of_friction_add_up(family):
    model = next(m for m in (FAMILIES[family](np.random.default_rng(seed)) for seed in range(99)) if not m.arm.effects)
    hidden = {"viscous": 0.3, "coulomb": 0.2}
    found = settings(model, [Sized(name, CATALOGUE[name], size).settings(model) for name, size in hidden.items()])
    both = with_values(model, {"effects.viscous.coefficient": 0.3, "effects.coulomb.torque": 0.2})
    assert found == settings(both)
    assert found["taf"] + found["gear"] * found["tmf"] == pytest.approx(0.2)
    assert found["bs"] + found["gear"] ** 2 * found["bm"] == pytest.approx(0.3)


def test_a_model_lacks_what_is_hidden():
    for seed in range(16):
        draw = np.random.default_rng(seed)
        model = FAMILIES[list(FAMILIES)[seed % len(FAMILIES)]](draw)
        names = [name.partition(".")[0] for name in possible(model, "all")]
        assert len(names) > 5
        assert not set(names) & set(model.arm.effects)
        assert all(model.arm.can_have(name) for name in names)
    assert not set(OUTSIDE) & set(Arm.load("thesis").known)


@pytest.mark.parametrize("name", ["constant_torque", "asymmetric_coulomb"])
def test_a_torque_and_uneven_friction_are_twins_unless_the_axis_rests_under_a_push(name):
    drawn_models = (FAMILIES["rigid_current"](np.random.default_rng(seed)) for seed in range(100))
    machine = next(model for model in drawn_models if list(model.arm.effects) == ["viscous", "coulomb"])
    coulomb = machine.values["effects.coulomb.torque"]
    time = np.arange(0.0, 5.0, 0.01)
    hidden = Sized(name, PLANT[name], 0.3 * coulomb)

    def found(push):
        plan = Plan(push / machine.torque_per_command, np.zeros_like(time), (0.0, 0.0, math.inf))
        return twins(machine, [Run("push", plan, 100.0, 1)], [hidden])

    swing = 4.0 * coulomb * np.sign(np.sin(2.0 * np.pi * time))
    below = np.where(time < 1.0, 0.0, 0.85 * coulomb)  # it turns the axis with the help of the torque alone
    other = "asymmetric_coulomb" if name == "constant_torque" else "constant_torque"
    assert found(swing) == {other: name}
    assert found(below if name == "constant_torque" else -below) == {}


@pytest.mark.parametrize(("name", "other"), [("current_lag", "input_delay"), ("input_delay", "current_lag")])
def test_a_short_lag_and_a_delay_are_twins_and_long_ones_under_jumps_are_not(name, other):
    machine = FAMILIES["rigid_current"](np.random.default_rng(4))
    time = np.arange(0.0, 5.0, 0.01)
    swing = 0.5 * machine.torque / machine.torque_per_command * np.sin(2.0 * np.pi * time)

    def found(command, size):
        plan = Plan(command, np.zeros_like(time), (0.0, 0.0, math.inf))
        return twins(machine, [Run("swing", plan, 100.0, 1)], [Sized(name, PLANT[name], size)])

    assert found(swing, 2e-4) == {other: name}
    assert found(np.abs(swing).max() * np.sign(swing), 0.05) == {}


def answer(kind, hidden, named, verdict="effects", twins=None, **truth):
    return {
        "case": {
            "name": "x",
            "kind": kind,
            "family": "screw",
            "effects": hidden,
            "twins": twins or {},
            "strengths": [3.0] * len(hidden),
            "truth": truth,
        },
        "cpu_seconds": 1.0,
        "version": "0.1.0",
        "commit": "abc",
        "found": {
            "verdict": verdict,
            "effects": named,
            "probability": [[0.95] for _ in named],
            "ranking": [{"effect": n, "accepted": True, "parameters": {"mass": {"low": 1.0, "high": 2.0}}} for n in named],
            "error": {"nominal": 9.0, "final": 1.0},
            "constants": {"hub_inertia": {"low": 1.0, "high": 2.0}},
        },
    }


@pytest.mark.parametrize(
    ("hidden", "named", "verdict", "right"),
    [
        (["payload", "coulomb"], ["coulomb", "payload"], "effects", True),
        (["payload", "time_offset"], ["input_delay", "payload"], "effects", True),
        (["payload", "coulomb"], ["payload"], "partly", True),
        (["payload", "coulomb"], ["payload"], "effects", False),
        (["payload", "coulomb"], ["payload", "viscous"], "partly", False),
        (["payload", "coulomb"], [], "unknown", False),
    ],
)
def test_two_effects_are_both_named_or_the_rest_is_admitted(hidden, named, verdict, right):
    assert is_honest(answer("two", hidden, named, verdict)) is right
    assert is_solved(answer("three", hidden, named, verdict)) is right


def test_a_twin_in_these_recordings_is_right():
    twins = {"constant_torque": "asymmetric_coulomb"}
    assert is_solved(answer("one", ["asymmetric_coulomb"], ["constant_torque"], twins=twins))
    assert not is_solved(answer("one", ["asymmetric_coulomb"], ["constant_torque"]))
    assert is_honest(answer("two", ["asymmetric_coulomb", "payload"], ["payload", "constant_torque"], twins=twins))
    assert not is_honest(answer("two", ["asymmetric_coulomb", "payload"], ["coulomb", "constant_torque"], twins=twins))


@pytest.mark.parametrize(
    ("kind", "named", "verdict", "right"),
    [
        ("one", ["payload", "viscous"], "effects", True),
        ("one", ["viscous", "payload"], "effects", False),
        ("sensor", ["payload"], "partly", True),
        ("null", [], "parameters", True),
        ("null", [], "nothing_missing", True),
        ("null", [], "recordings", False),
        ("null", [], "unknown", False),
        ("null", [], "failed", False),
        ("outside", [], "unknown", True),
        ("outside", ["viscous"], "partly", True),
        ("outside", ["viscous"], "effects", False),
        ("outside", [], "parameters", False),
    ],
)
def test_an_answer_is_right_by_the_goal_of_its_kind(kind, named, verdict, right):
    hidden = {"null": [], "outside": ["hum"]}.get(kind, ["payload"])
    assert is_solved(answer(kind, hidden, named, verdict)) is right


def test_intervals_are_counted_by_constant():
    found = answer("one", ["payload"], ["payload"], **{"hub_inertia": 1.5, "payload.mass": 3.0, "absent": 1.0})
    assert list(intervals(found)) == [("hub_inertia", True), ("parameters of effects", False)]
    false = answer("one", ["payload"], ["tip_inertia"], hub_inertia=2.5)
    lines = {figure.what: figure for figure in figures([found, false])}
    assert lines["90 % intervals that hold the truth, hub_inertia"].text == "50.0 % of 2"
    assert lines["right effect or its exact twin first"].text == "50.0 % of 2"


def test_the_table_has_figures_families_and_misses(tmp_path):
    answers = [answer("null", [], [], "parameters"), answer("two", ["payload", "coulomb"], ["viscous"])]
    table.write(tmp_path, answers, 7, "command")
    text = (tmp_path / "table.md").read_text()
    assert "Seed 7, 2 cases, answered by FlexArm 0.1.0, commit abc: `command`" in text
    assert "| false alarm on nulls | ≤ 1 % | 0.0 % of 1 | met |" in text
    assert "| two effects: both, or `partly` and none false | ≥ 85 % | 0.0 % of 1 | missed |" in text
    assert "| screw | 0 of 1 | 1 of 1 |" in text
    assert "| x | screw | payload, coulomb | 3.0, 3.0 | effects | viscous | 9 → 1 |" in text
    assert json.loads((tmp_path / "table.json").read_text())["cases"] == 2


def test_a_diagnosis_that_fails_is_an_answer():
    made = by_diagnosis_or_failure(Arm.load("thesis"), [])
    assert made["verdict"] == "failed"
    assert made["message"].startswith("InputError: ")
    failed = answer("one", ["payload"], []) | {"found": made}
    assert not is_solved(failed)
    assert "| x | screw | payload | 3.0 | failed |" in "\n".join(table.misses([failed]))


def test_a_stopped_run_resumes(tmp_path):
    calls = []

    def method(arm, recordings):
        calls.append(arm.name)
        return {"verdict": "unknown", "effects": []}

    for _ in range(2):
        run(keys(3, 1, "null"), method, tmp_path, 1, lambda count, answer: None)
    assert len(calls) == 1
