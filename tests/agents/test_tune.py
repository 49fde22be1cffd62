"""The search of laws and policies: judged alike, resumed bit for bit, refused in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("stable_baselines3")
pytest.importorskip("optuna")

from agents.learning.episodes import SEEDS_EACH
from agents.learning.options import Plan
from agents.learning.plan_file import read_table
from agents.tune import PLAN_SPACE, changed, main, tune_policy
from flexarm_env import Arm
from flexarm_env.controllers.tuned import TunedController
from flexarm_env.trials.sets import DEVELOPMENT_SEED, FIRST_SEED, SEARCH_SEED
from flexarm_env.tuning import judge
from flexarm_env.tuning.search import Budget

TINY = "actions = 20\nat_once = 2\n[network]\nlayers = [4]\n[learning]\nbatch_size = 20\n[interface]\nrepeat = 100\n"


def test_what_is_searched_are_options_and_within_their_bounds() -> None:
    for end in (0, 1):
        values = {path: each[end] for path, each in PLAN_SPACE.items()}
        table = changed(Plan(), values).table()
        assert all(table[path.split(".")[0]][path.split(".")[1]] == value for path, value in values.items())
    assert changed(Plan(), {}) == read_table({})


def test_the_arms_of_training_development_search_and_evaluation_are_apart() -> None:
    assert 50 * SEEDS_EACH < DEVELOPMENT_SEED  # of dozens of training seeds none comes there
    assert DEVELOPMENT_SEED + judge.SEEDS_EACH < SEARCH_SEED
    assert SEARCH_SEED + 1000 * judge.SEEDS_EACH < FIRST_SEED


def test_a_law_becomes_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judge, "CELLS", judge.CELLS[:1])
    command = ["pd", "--trials", "3", "--arms", "2", "--save", str(tmp_path)]
    assert main(command) == 0
    found = TunedController.load(tmp_path / "pd_tuned.toml")
    assert found.search["score"] <= found.search["score_before"]
    assert set(found.options) == {"proportional", "derivative"}


@pytest.mark.slow
def test_the_search_of_a_policy_goes_on_where_another_stopped(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "tiny.toml").write_text(TINY)
    command = [str(tmp_path / "tiny.toml"), "--actions", "20", "--arms", "2", "--journal", str(tmp_path / "search.journal")]
    assert main([*command, "--trials", "1"]) == 0
    assert main([*command, "--trials", "2"]) == 0
    assert "2 of 2" in capsys.readouterr().err


def test_trials_of_another_configuration_or_arm_are_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config, arm, journal = tmp_path / "tiny.toml", tmp_path / "arm.toml", tmp_path / "search.journal"
    trained = []

    def score_of(plan: Plan, *rest: object) -> float:
        trained.append((plan.interface.base, Arm.load(plan.arm).value("hub.inertia")))
        return 1.0

    monkeypatch.setattr("agents.tune.score_of", score_of)
    monkeypatch.setattr(judge, "CELLS", judge.CELLS[:1])
    heavy = Arm.load("thesis").with_values({"hub.inertia": 0.3})
    for base, machine in (("none", Arm.load("thesis")), ("pd", Arm.load("thesis")), ("pd", heavy), ("pd", heavy)):
        machine.save(arm)
        config.write_text(f"arm = '{arm}'\n{TINY}base = '{base}'\n")
        tune_policy(config, 20, Budget(trials=1, arms=2), journal)
    light = Arm.load("thesis").value("hub.inertia")
    assert trained == [("none", light), ("pd", light), ("pd", 0.3)]


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["pdd"], "did you mean 'pd'"),
        (["pd", "--trials", "0"], "trial"),
        (["pd", "--arm", "thesys"], "thesis"),
        (["vibration_dual", "--arm", "cu-rigid"], "strain"),
        (["pd", "--arm", "emps"], "motor_speed"),
        (["pd", "--journal", "none/a.journal"], "no folder"),
        (["none.toml"], "none.toml"),
    ],
)
def test_bad_arguments_give_one_line(arguments: list[str], word: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert word in error
    assert error.count("\n") == 1
