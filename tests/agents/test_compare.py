"""The comparison of stored policies with controllers: one command, goals judged by intervals."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from agents import compare as command
from agents.goals import GOALS, THESIS, against_classical, against_thesis, cell_of, verdicts
from agents.learning.plan_file import read_table
from agents.learning.run import train
from flexarm_env.controllers import CONTROLLERS
from flexarm_env.trials.sets import SETS


def values(settling: float, error: float, strain: float) -> dict[str, np.ndarray]:
    spread = 1.0 + 0.01 * np.random.default_rng(0).normal(size=(1, 40))
    return {"settling_time": settling * spread, "steady_error": error * spread, "residual_strain": strain * spread}


def judged(policy: dict[str, np.ndarray], **rivals: dict[str, np.ndarray]) -> list[dict]:
    every = {"policy": policy, **rivals}
    return verdicts("policy", list(rivals), {name: cell_of(found) for name, found in every.items()}, every)


def test_each_measure_is_held_against_the_best_in_that_measure() -> None:
    found = judged(values(1.0, 0.1, 0.01), slow=values(5.0, 0.2, 0.1), rough=values(2.0, 4.0, 0.2))
    assert [(verdict["measure"], verdict["rival"]) for verdict in found] == [
        ("settling_time", "rough"),
        ("steady_error", "slow"),
        ("residual_strain", "slow"),
    ]
    assert found[0]["less_by"] == pytest.approx(0.5)
    assert [against_thesis(verdict) for verdict in found] == ["reached", "missed by 30 points", "reached"]
    assert [against_classical(verdict) for verdict in found] == ["better"] * 3
    assert found[0]["improvement"]["probability"] == 1.0


def test_a_loss_and_a_tie_are_called_so() -> None:
    found = judged(values(1.0, 0.4, 0.01), other=values(1.001, 0.2, 0.02))
    assert [against_classical(verdict) for verdict in found] == ["no difference", "worse", "better"]
    assert against_thesis(found[0]) == "missed: intervals touch"


def test_the_thesis_s_controllers_exist() -> None:
    assert set(THESIS) < set(CONTROLLERS)
    assert set(GOALS) == {"settling_time", "steady_error", "residual_strain"}


def test_one_command_compares_what_is_stored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = {name: CONTROLLERS[name] for name in ("pd", "vibration_low", "lqg")}
    monkeypatch.setattr(command, "CONTROLLERS", few)
    monkeypatch.setattr(command, "THESIS", ("pd", "vibration_low"))
    monkeypatch.setattr(command, "SETS", {"randomised": SETS["randomised"]})
    plan = {"at_once": 2, "actions": 20, "network": {"layers": [4]}, "learning": {"batch_size": 20}, "interface": {"repeat": 100}}
    for seed in range(2):
        train(read_table(plan), seed, None, lambda share, text: None).save(tmp_path / "weights" / f"tiny-{seed}.safetensors")
    arguments = ["--policies", str(tmp_path / "weights"), "--save", str(tmp_path), "--count", "3", "--jobs", "1"]
    assert command.main(arguments) == 0
    result = json.loads((tmp_path / "policies.json").read_text())
    cells = result["tasks"]["slew"]["randomised"]["cells"]
    assert set(cells) == {*few, "tiny"}
    assert "tiny" not in result["tasks"]["damp"]["randomised"]["cells"]
    assert cells["tiny"]["steady_error"]["low"] <= cells["tiny"]["steady_error"]["iqm"] <= cells["tiny"]["steady_error"]["high"]
    assert [run["seed"] for run in result["policies"]["tiny"]["runs"]] == [0, 1]
    table = (tmp_path / "policies.md").read_text()
    assert "goal 40 %" in table
    assert (tmp_path / "curves.png").read_bytes().startswith(b"\x89PNG")


def test_an_empty_folder_is_refused_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--policies", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert "agents.train" in error
    assert error.count("\n") == 1
