"""The command that tunes a controller: tables, file, JSON; a file whole or not at all."""

from __future__ import annotations

import json

import pytest

pytest.importorskip("optuna")

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.tuning import judge, search


@pytest.fixture(autouse=True)
def short(monkeypatch) -> None:
    monkeypatch.setattr(judge, "CELLS", judge.CELLS[:1])


def test_tune_writes_a_controller_that_drives_the_arm(flexarm, tmp_path):
    place, answer = tmp_path / "pd.toml", tmp_path / "pd.json"
    arm = tmp_path / "biased.toml"
    Arm.load("thesis").with_effect("constant_torque", torque=0.05).save(arm)
    command = ("tune", "pd", "--arm", arm, "--trials", "3", "--arms", "2", "--save", place, "--json", answer)
    assert flexarm(*command) == 0
    found = json.loads(answer.read_text())
    assert "phase margin" in flexarm.out
    assert found["margins"]["delay"] > 0.0
    assert found["search"]["trials"] == 3
    made = make_controller(str(place), Arm.load(arm), 0.005)
    assert made.proportional == found["options"]["proportional"]


def test_a_stopped_search_writes_no_controller(flexarm, tmp_path, monkeypatch):
    def stop(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(search.judge, "score", stop)
    assert flexarm("tune", "pd", "--trials", "2", "--save", tmp_path / "pd.toml") == 130
    assert not (tmp_path / "pd.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("tune", "lqk"), "did you mean 'lqg'"),
        (("tune", "pd", "--arm", "emps"), "motor_speed"),
        (("tune", "pd", "--save", "none/pd.toml"), "no folder"),
        (("tune", "pd", "--journal", "none/a"), "no folder"),
        (("tune", "pd", "--trials", "0"), "trials"),
    ],
)
def test_bad_input_gives_one_line(flexarm, arguments, word):
    assert word in flexarm.refused(*arguments)
