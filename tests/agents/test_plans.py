"""Plans of training, and the options that they take."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

pytest.importorskip("stable_baselines3")

from agents.learning.episodes import RATE
from agents.learning.options import Plan
from agents.learning.plan_file import option_table, read_plan, read_table
from agents.train import main
from flexarm_env import InputError
from flexarm_env.tasks import TASKS

CONFIGS = sorted((Path(__file__).parents[2] / "configs" / "agents").glob("*.toml"))


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.stem)
def test_every_shipped_configuration_is_read(path: Path) -> None:
    plan = read_plan(path)
    assert read_table(json.loads(json.dumps(plan.table()))) == plan
    if plan.algorithm == "ppo":
        steps = TASKS[plan.task].duration * RATE // plan.interface.repeat
        assert steps * plan.at_once % plan.learning.batch_size == 0


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"algoritm": "ppo"}, "unknown key 'algoritm'; did you mean 'algorithm'?"),
        ({"learning": {"gama": 0.9}}, "unknown key 'learning.gama'; did you mean 'gamma'?"),
        ({"algorithm": "pp"}, "did you mean 'ppo'?"),
        ({"learning": {"gamma": 1.5}}, "learning.gamma = 1.5; allowed are 0 to 1"),
        ({"learning": {"gamma": 10**400}}, "learning.gamma = inf; allowed are 0 to 1"),
        ({"actions": -(10**400)}, "actions = -inf; allowed are "),
        ({"learning": {"gamma": "high"}}, "give a number"),
        ({"at_once": 2.5}, "give a whole number"),
        ({"interface": {"lags": 3}}, "give a list"),
        ({"interface": {"estimate": 1}}, "give true or false"),
        ({"interface": {"base": "lgq"}}, "did you mean 'lqg'?"),
        ({"reward": 3}, "write [reward]"),
    ],
)
def test_a_wrong_option_is_named_in_one_line(table: dict, words: str) -> None:
    with pytest.raises(InputError) as error:
        read_table(table)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_every_option_is_documented(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--options"]) == 0
    shown = capsys.readouterr().out
    assert shown == option_table()
    for section, entries in Plan().table().items():
        for name in entries if isinstance(entries, dict) else [section]:
            assert f"{name}`" in shown


def test_the_documentation_lists_every_option() -> None:
    document = (Path(__file__).parents[2] / "docs" / "policies.md").read_text(encoding="utf-8")
    written = document.split("<!-- options -->\n")[1].split("<!-- /options -->")[0]
    assert written == option_table(), "docs/policies.md has other options than: python -m agents.train --options"


@pytest.mark.parametrize(("name", "text", "word"), [("a.toml", "x = [", "TOML"), ("b.toml", "steps = 3\n", "steps")])
def test_the_command_refuses_a_bad_file_in_one_line(
    name: str, text: str, word: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_text(text)
    assert main([str(tmp_path / name)]) == 2
    error = capsys.readouterr().err
    assert word in error
    assert error.count("\n") == 1
