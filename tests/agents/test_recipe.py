"""The recipe of the page on learning, and what it says of single readings."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest

pytest.importorskip("stable_baselines3")

from agents import recipe
from agents.recipe_report import NEAR, Idle, foresight, mean_return, report_of, runs_of, write_report
from flexarm_env import Arm
from flexarm_env.controllers import make_controller

RESULTS = Path(__file__).parents[2] / "results" / "recipe"
MEANINGS = {name: each.meaning for name, each in recipe.RECIPES.items()}


def stored() -> dict:
    return json.loads((RESULTS / "reference.json").read_text(encoding="utf-8"))


def test_one_reading_lacks_what_two_have() -> None:
    for count in (1, 2):
        assert foresight(count) == pytest.approx(stored()["r2"][str(count)], abs=0.02)
    assert foresight(1) < 0.6
    assert foresight(2) > 0.98


def test_returns_of_reference_are_measured_again() -> None:
    known = stored()["returns"]
    assert mean_return(Idle(), 2) == pytest.approx(known["no command"], abs=1.0)
    assert mean_return(make_controller("pd", Arm.load("thesis"), 0.005), 4) == pytest.approx(known["pd"], abs=3.0)


def test_every_run_with_two_readings_ends_within_a_degree() -> None:
    runs = runs_of(RESULTS)
    for name in ("added", "alone"):
        assert sorted(run["seed"] for run in runs[name]) == [0, 1, 2, 3, 4]
        for run in runs[name]:
            assert run["actions"] == recipe.RECIPES[name].steps <= 500_000
            assert len(run["errors"]) == recipe.JUDGED
            assert max(run["errors"]) < NEAR
    assert any(max(run["errors"]) > NEAR for run in runs["bare"])


def test_the_report_is_of_the_stored_runs() -> None:
    assert (RESULTS / "recipe.md").read_text(encoding="utf-8") == report_of(runs_of(RESULTS), stored(), MEANINGS)


def test_the_command_trains_and_reports(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    short = dataclasses.replace(recipe.RECIPES["added"], steps=2048, every=2048)
    monkeypatch.setattr(recipe, "RECIPES", {"added": short})
    monkeypatch.setattr(recipe, "JUDGED", 2)
    monkeypatch.setattr(recipe, "WATCHED", 1)
    monkeypatch.setattr("agents.recipe_report.references", lambda: {"pd": -308.2})
    assert recipe.main(["--seeds", "3", "--save", str(tmp_path)]) == 0
    (run,) = runs_of(tmp_path)["added"]
    assert (run["seed"], run["actions"], len(run["errors"])) == (3, 2048, 2)
    assert run["curve"][0][1] == pytest.approx(-308.0, abs=20.0)  # at the start it is nearly the PD alone
    assert run["curve"][-1][1] > run["curve"][0][1]
    assert (tmp_path / "curves.png").is_file()
    write_report(tmp_path, {"added": "x"})
    assert recipe.main(["aded"]) == 2
    assert recipe.main(["--seeds", "-1"]) == 2
