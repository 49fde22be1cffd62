"""The search: one seed one answer, resumed bit for bit, never worse than where it started."""

from __future__ import annotations

import re
import sys

import pytest

pytest.importorskip("optuna")

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.tuned import TunedController, on_drive
from flexarm_env.errors import InputError
from flexarm_env.tuning import judge
from flexarm_env.tuning.search import Budget, first_values, tune
from flexarm_env.tuning.spaces import SPACES, Range, nested
from flexarm_env.tuning.study import Study

SPACE = {"x": Range(-2.0, 3.0, False), "y": Range(0.01, 10.0)}


def bowl(values):
    return (values["x"] - 1.0) ** 2 + (values["y"] - 0.5) ** 2


def test_the_search_finds_the_bottom_of_a_bowl() -> None:
    study = Study("bowl", SPACE)
    study.run(120, 0, bowl)
    assert study.best()[1] < 0.05


def test_one_seed_gives_one_answer_and_another_another() -> None:
    studies = [Study("bowl", SPACE) for _ in range(3)]
    for study, seed in zip(studies, (3, 3, 4), strict=True):
        study.run(30, seed, bowl)
    assert studies[0].best() == studies[1].best() != studies[2].best()


@pytest.mark.parametrize("seed", [2**32 - 1, 10**30])
def test_a_seed_of_any_size_is_one(seed) -> None:
    study = Study("bowl", SPACE)
    study.run(3, seed, bowl)
    assert len(study.finished()) == 3


def test_a_stopped_search_goes_on_as_if_it_had_not_stopped(tmp_path) -> None:
    calls = []

    def stopped(values):
        calls.append(values)
        if len(calls) == 20:
            raise KeyboardInterrupt
        return bowl(values)

    place = tmp_path / "search.journal"
    with pytest.raises(KeyboardInterrupt):
        Study("bowl", SPACE, place).run(40, 0, stopped, {"x": 0.0, "y": 1.0})
    resumed = Study("bowl", SPACE, place)
    assert len(resumed.finished()) == 19
    resumed.run(40, 0, bowl, {"x": 0.0, "y": 1.0})
    whole = Study("bowl", SPACE)
    whole.run(40, 0, bowl, {"x": 0.0, "y": 1.0})
    assert [trial.params for trial in resumed.finished()] == [trial.params for trial in whole.finished()]
    assert resumed.finished()[0].params == {"x": 0.0, "y": 1.0}


@pytest.mark.parametrize("content", [b"no journal", b"\xff\xfe", b"{}\n"])
def test_a_file_that_is_no_journal_is_refused(tmp_path, content) -> None:
    (tmp_path / "a.journal").write_bytes(content)
    with pytest.raises(InputError, match="no journal") as error:
        Study("bowl", SPACE, tmp_path / "a.journal")
    assert "\n" not in str(error.value)
    assert (tmp_path / "a.journal").read_bytes() == content


def test_a_search_goes_on_though_it_was_killed_within_a_line_of_its_journal(tmp_path) -> None:
    place = tmp_path / "search.journal"
    Study("bowl", SPACE, place).run(6, 0, bowl)
    place.write_bytes(place.read_bytes()[:-20])
    resumed = Study("bowl", SPACE, place)
    assert len(resumed.finished()) == 5
    resumed.run(8, 0, bowl)
    whole = Study("bowl", SPACE)
    whole.run(8, 0, bowl)
    assert resumed.best() == whole.best() == Study("bowl", SPACE, place).best()


@pytest.mark.parametrize(
    ("pattern", "text"),
    [
        (rb'"values":\[[^]]*\]', b'"values":[]'),
        (rb'"values":\[[^]]*\]', b'"values":null'),
        (rb'"values":\[[^]]*\]', b'"values":[NaN]'),
        (rb'"values":\[[^]]*\]', b'"values":[-Infinity]'),
        (rb'"values":\[[^]]*\]', b'"values":["x",1]'),
        (rb'"param_value_internal":[^,]*', b'"param_value_internal":NaN'),
        (rb'"low', b'"lew'),
        (rb'"param_name":"x"', b'"param_name":"z"'),
        (rb"\n", b"\n[]\n"),
        (rb"\n", b"\n" + b"[" * 100_000 + b"\n"),
    ],
)
def test_a_damaged_journal_is_refused(tmp_path, pattern, text) -> None:
    place = tmp_path / "search.journal"
    Study("bowl", SPACE, place).run(4, 0, bowl)
    place.write_bytes(re.sub(pattern, text, place.read_bytes(), count=4))
    with pytest.raises(InputError, match="or a damaged one; name another file") as error:
        Study("bowl", SPACE, place)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", SPACES)
def test_a_law_stands_at_both_ends_of_its_ranges(name) -> None:
    if name == "mpc":
        pytest.importorskip("daqp")
    arm = Arm.load("thesis")
    for end in (0, 1):
        make_controller(name, arm, 0.005, **on_drive(arm, nested({path: each[end] for path, each in SPACES[name].items()})))
    own = first_values(name, arm, SPACES[name])
    assert all(SPACES[name][path].low <= value <= SPACES[name][path].high for path, value in own.items())


@pytest.mark.parametrize("arm", ["thesis", "cu-rigid"])
def test_a_law_s_first_values_make_the_law(arm) -> None:
    model = Arm.load(arm)
    values = first_values("pd", model, SPACES["pd"])
    made, own = make_controller("pd", model, 0.005, **on_drive(model, values)), make_controller("pd", model, 0.005)
    assert made.proportional == pytest.approx(own.proportional)
    assert made.derivative == pytest.approx(own.derivative)


def test_without_optuna_a_search_is_refused_in_one_line(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "optuna", None)
    with pytest.raises(InputError, match=r"flexarm-env\[control\]") as error:
        Study("bowl", SPACE)
    assert "\n" not in str(error.value)


def test_tuning_improves_the_score_and_writes_the_budget(monkeypatch, tmp_path) -> None:
    monkeypatch.setattr(judge, "CELLS", judge.CELLS[:2])
    budget = Budget(trials=4, arms=2, seed=1)
    found, again = (tune("pd", Arm.load("thesis"), budget) for _ in range(2))
    assert found == again
    assert found.search["score"] <= found.search["score_before"]
    assert {"trials": 4, "arms": 2, "seed": 1}.items() <= found.search.items()
    found.save(tmp_path / "pd.toml")
    assert TunedController.load(tmp_path / "pd.toml") == found
    made = make_controller(str(tmp_path / "pd.toml"), Arm.load("thesis"), 0.005)
    assert made.proportional == found.options["proportional"]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("", "no tuned controller"),
        ("controller = 1", "no tuned controller"),
        ('controller = "pdd"\narm = "thesis"\nversion = "0.1.0"', "did you mean 'pd'"),
        ('controller = "pd"\narm = "thesis"\nversion = "0.1.0"\n[options]\ngain = 1.0', "no option 'gain'"),
        ("controller =", "not TOML"),
    ],
)
def test_a_file_that_is_no_controller_is_refused_in_one_line(tmp_path, text, word) -> None:
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(InputError, match=word) as error:
        make_controller(str(tmp_path / "a.toml"), Arm.load("thesis"), 0.005)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("law", "options", "words"),
    [
        ("pd", {"proportional": "2"}, "give a finite number"),
        ("pd", {"proportional": [1.0]}, "give a finite number"),
        ("pd", {"proportional": 10**400}, "give a finite number"),
        ("lqg", {"design": {"dead_time": 10**400}}, "give a finite number"),
        ("pd", {"derivative": float("nan")}, "give a finite number"),
        ("lqg", {"order": 0}, "a whole number from 1 up"),
        ("lqg", {"design": {"dead_time": 1e9}}, "give at most 20 s"),
        ("mpc", {"design": {"horizon": 1e6}}, "give at most 20 s"),
        ("vibration_dual", {"friction_compensation": "no"}, "give true or false"),
        ("shaped_zv", {"shaper": 3}, "give a text"),
    ],
)
def test_a_value_that_an_option_cannot_have_is_refused_in_one_line(tmp_path, law, options, words) -> None:
    TunedController(law, "thesis", "0.1.0", options).save(tmp_path / "a.toml")
    with pytest.raises(InputError, match=words) as error:
        make_controller(str(tmp_path / "a.toml"), Arm.load("thesis"), 0.005)
    assert "\n" not in str(error.value)


def test_a_set_that_an_arm_cannot_have_is_left_out_of_its_score() -> None:
    arm = Arm.load("cu-flexible")
    cells = judge.cells_of(arm, 12, 0)
    assert ("slew", "randomised") in cells
    assert ("slew", "constants_30") not in cells  # so far apart, some of its arms are built in another way
    assert judge.cells_of(Arm.load("thesis"), 12, 0) == list(judge.CELLS)


def test_a_search_starts_from_a_tuned_controller(monkeypatch) -> None:
    monkeypatch.setattr(judge, "CELLS", judge.CELLS[:1])
    thesis = Arm.load("thesis")
    start = TunedController("vibration_dual", "thesis", "0.1.0", {"high_gain": -0.5, "proportional": 3.0})
    values = first_values("vibration_dual", thesis, SPACES["vibration_dual"], start)
    assert (values["high_gain"], values["proportional"], values["low_gain"]) == (-0.5, 3.0, 1.0)
    found = tune("vibration_dual", thesis, Budget(1, 2), start=start)
    assert found.options == pytest.approx(values)
    with pytest.raises(InputError, match="cannot start from vibration_dual"):
        tune("pd", thesis, Budget(1, 2), start=start)
    with pytest.raises(InputError, match="no option 'gain'"):
        tune("pd", thesis, Budget(1, 2), start=TunedController("pd", "thesis", "0.1.0", {"gain": 1.0}))
