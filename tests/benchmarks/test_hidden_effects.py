"""The benchmark of hidden effects: its cases are keyed, its table says what was answered, a stopped run goes on."""

from __future__ import annotations

import json

import numpy as np
import pytest

import flexarm_env
from benchmarks.answers.run import run
from benchmarks.hidden_effects import table, truth
from benchmarks.hidden_effects.baselines import best_fit_wins, stepwise
from benchmarks.hidden_effects.cases import CATALOGUE, Case, cases, sample
from benchmarks.hidden_effects.score import confusions, figures
from benchmarks.hidden_effects.sindy import sparse_effects
from flexarm_env.arm import Arm
from flexarm_env.effects import catalogue
from flexarm_env.experiments.simulate import simulate
from flexarm_env.terminal.provenance import commit


def answer(case, effects, verdict="effects", final=1.0):
    return {
        "case": case.as_json(),
        "cpu_seconds": 1.0,
        "version": "0.1.0",
        "commit": "abc",
        "found": {
            "verdict": verdict,
            "effects": effects,
            "equivalent": [[e] for e in effects],
            "probability": [[0.95] for _ in effects],
            "ranking": [{"effect": e, "accepted": True, "parameters": {}} for e in effects],
            "error": {"nominal": 9.0, "refitted": 5.0, "final": final},
            "constants": {},
        },
    }


@pytest.fixture(scope="module")
def made() -> list[Case]:
    """Draw the cases of one seed, once."""
    return cases(1)


def test_cases_are_as_many_and_as_mixed_as_they_say(made):
    kinds = [case.kind for case in made]
    assert len(made) >= 250
    assert kinds.count("null") == 60
    assert len({c.effects for c in made if c.kind == "one"}) >= 20
    assert len({c.effects for c in made if c.kind == "outside"}) >= 6
    assert len({c.name for c in made}) == len(made)
    assert {run for c in made for run in c.runs} >= {("square", 0.6, 0.0), ("square", 1.0, 0.15)}


def test_a_seed_gives_the_same_cases_and_another_others(made):
    assert cases(1) == made
    assert all(a.settings != b.settings for a, b in zip(made, cases(2), strict=True) if a.kind in ("one", "outside"))


def test_a_sample_is_of_all_kinds_and_part_of_a_larger_one(made):
    small, whole = sample(1, 60), sample(1, len(made))
    assert whole[:60] == small
    assert {c.kind for c in small} == {"one", "two", "outside", "null"}
    assert {c.name for c in whole} == {c.name for c in made}


def test_a_saturation_is_below_the_largest_command(made):
    case = next(c for c in made if c.effects == ("saturation",))
    commands = [np.abs(run.command).max() for run in case.recordings()]
    assert max(commands) > case.settings["sat"]


def test_every_effect_is_in_the_catalogue():
    assert set(CATALOGUE) <= set(catalogue())
    for effect in set(CATALOGUE) & set(truth.PARAMETERS):
        assert set(truth.PARAMETERS[effect]) <= set(catalogue()[effect].parameters), effect


def test_a_machine_is_recorded_with_what_is_known_of_it(made):
    case = next(c for c in made if ("square", 1.0, 0.15) in c.runs and c.kind == "null")
    runs = case.recordings()
    assert [r.conditions.get("payload", 0.0) for r in runs] == [0.0, 0.15, 0.0]
    again = case.recordings()
    assert all(np.array_equal(a.signals["arm_angle"], b.signals["arm_angle"]) for a, b in zip(runs, again, strict=True))


def test_the_table_counts_what_was_answered(made, tmp_path):
    threes = [c for c in made if c.kind == "one" and c.strength == 3.0]
    nulls = [c for c in made if c.kind == "null"]
    answers = [answer(c, list(c.effects)) for c in threes[1:]] + [answer(threes[0], ["viscous"])]
    answers += [answer(nulls[0], ["viscous"])] + [answer(c, [], "nothing_missing") for c in nulls[1:]]
    found = {f.what: f for f in figures(answers)}
    assert found["right effect first, strength 3"].value == pytest.approx(1.0 - 1.0 / len(threes))
    assert found["false alarm on nulls"].value == pytest.approx(1.0 / 60.0)
    assert found["false alarm on nulls"].met
    assert confusions(answers) == [(threes[0].effects[0], "viscous", 1)]
    answers[0]["commit"] = "abd"
    table.write(tmp_path, answers, "diagnose", 1, "command")
    assert "answered by FlexArm 0.1.0, commit abc, abd: `command`" in (tmp_path / "table.md").read_text()
    assert "| false alarm on nulls | ≤ 2 % | 1.7 % of 60 | met |" in (tmp_path / "table.md").read_text()
    assert json.loads((tmp_path / "table.json").read_text())["cases"] == len(answers)


def test_an_exact_twin_is_as_good_in_its_own_line_only(made):
    late = next(c for c in made if c.effects == ("time_offset",) and c.strength == 3.0)
    pair = next(c for c in made if c.kind == "two" and "dead_zone" in c.effects)
    twins = [name.replace("dead_zone", "brush_drop") for name in pair.effects]
    found = {f.what: f.value for f in figures([answer(late, ["input_delay"]), answer(pair, twins)])}
    assert found["right effect first, strength 3"] == found["two effects, both right, strength 3"] == 0.0
    assert found["right effect or its exact twin first, strength 3"] == 1.0
    assert found["two effects, both right or exact twins, strength 3"] == 1.0
    assert found["sensor against plant side"] == 0.0


def test_of_what_no_case_says_there_is_none(made, tmp_path):
    null = next(c for c in made if c.kind == "null")
    folder = tmp_path / "mine-1"
    found = table.write(folder, [answer(null, [], "nothing_missing")], "mine", 1, "command")
    assert {f.what for f in found if f.met} == {"false alarm on nulls", "time of one core for three recordings, median"}
    assert "| two effects, both right, strength 3 | ≥ 80 % | none |  |" in (folder / "table.md").read_text()
    assert "NaN" not in (folder / "table.json").read_text()


def test_a_stopped_run_goes_on(made, tmp_path):
    chosen = made[:2]
    calls = []

    def method(arm, recordings):
        calls.append(len(recordings))
        return {"verdict": "unknown", "effects": []}

    for _ in range(2):
        run(chosen, method, tmp_path, 1, lambda count, answer: None)
    assert calls == [3, 3]
    kept = json.loads((tmp_path / f"{chosen[0].name}.json").read_text())
    assert (kept["version"], kept["commit"]) == (flexarm_env.__version__, commit())


@pytest.mark.parametrize(
    ("name", "effect", "values"),
    [
        ("cable_stiffness", "cable_stiffness", {"stiffness": 0.15, "rest_angle": 0.0}),
        ("asymmetric_viscous", "asymmetric_viscous", {"coefficient": 0.05}),
    ],
)
def test_sindy_finds_what_acts_on_the_hub_of_an_arm_that_is_right_otherwise(name, effect, values):
    arm = Arm.load("thesis-fem")
    runs = [simulate(arm.with_effect(effect, **values), experiment, seed=1) for experiment in ("square", "sweep")]
    assert sparse_effects(arm, runs)[0] == name
    assert sparse_effects(arm, [simulate(arm, "square", seed=1)]) == []


@pytest.mark.slow
def test_stepwise_adds_until_the_criterion_rises_and_keeps_its_first_step():
    arm = Arm.load("thesis")
    runs = [simulate(arm.with_effect("constant_torque", torque=0.05), "pulse", seed=1)]
    found = stepwise(arm, runs)
    assert found["effects"][0] == "constant_torque"
    first = best_fit_wins({"case": "its own", "found": found, "cpu_seconds": 1000.0})
    assert first["found"]["effects"] == ["constant_torque"]
    assert first["found"]["error"]["final"] < 1.1 < first["found"]["error"]["refitted"]
    assert 0.0 < first["cpu_seconds"] < 1000.0
    assert stepwise(arm, [simulate(arm, "square", seed=1)])["effects"] == []
