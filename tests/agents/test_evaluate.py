"""Evaluation: measures against closed forms, the same arms for all, one command to the table."""

from __future__ import annotations

import json

import numpy as np
import pytest

from agents.evaluate import evaluate_controller, main
from agents.statistics import mean_interval, paired_difference
from flexarm_env import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import MEASURES, Trajectories, measure
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.sets import SETS

INTERVAL = 0.005


def made(tip: np.ndarray, target: float = 1.0, **changes: np.ndarray) -> Trajectories:
    steps = len(tip)
    parts = {"strain": np.zeros((steps, 1)), "command": np.zeros((steps, 1)), "failed": np.zeros(1, dtype=bool)}
    return Trajectories(tip[:, None], np.full((steps, 1), target), start=np.zeros(1), interval=INTERVAL, **(parts | changes))


def test_measures_of_an_exponential_approach() -> None:
    time = INTERVAL * np.arange(1, 1001)
    found = measure(made(1.0 - np.exp(-time / 0.3)), TASKS["slew"])
    assert found["settling_time"][0] == pytest.approx(-0.3 * np.log(np.deg2rad(1.0)), abs=2 * INTERVAL)
    assert found["overshoot"][0] == 0.0
    assert found["unsettled"][0] == 0.0
    assert found["steady_error"][0] < 1e-3


def test_measures_of_an_overshoot_vibration_and_command() -> None:
    time = INTERVAL * np.arange(1, 1001)
    tip = np.where(time < 1.0, 1.2, 1.05)
    strain, command = 0.3 * np.sin(2 * np.pi * 4.0 * time), np.where(time <= 2.0, -3.0, 0.0)
    found = measure(made(tip, strain=strain[:, None], command=command[:, None]), TASKS["slew"])
    assert found["overshoot"][0] == pytest.approx(np.rad2deg(0.2))
    assert found["steady_error"][0] == pytest.approx(np.rad2deg(0.05))
    assert found["settling_time"][0] == pytest.approx(5.0)
    assert found["unsettled"][0] == 100.0
    assert found["residual_strain"][0] == pytest.approx(0.3 / np.sqrt(2.0), rel=1e-3)
    assert found["peak_current"][0] == 3.0
    assert found["energy"][0] == pytest.approx(9.0 * 2.0)


def test_an_arm_that_failed_never_settled() -> None:
    found = measure(made(np.ones(1000), failed=np.ones(1, dtype=bool)), TASKS["slew"])
    assert found["settling_time"][0] == 5.0
    assert found["unsettled"][0] == 100.0
    assert found["steady_error"][0] == 180.0


def test_a_track_is_measured_stretch_by_stretch() -> None:
    half = np.ones(500)
    target = np.concatenate([half, -half, half, -half])
    seen = Trajectories(
        target[:, None] * 1.1,
        target[:, None],
        *(np.zeros((2000, 1)) for _ in range(2)),
        np.zeros(1, dtype=bool),
        np.zeros(1),
        0.005,
    )
    found = measure(seen, TASKS["track"])
    assert found["overshoot"][0] == pytest.approx(np.rad2deg(0.1))
    assert found["settling_time"][0] == pytest.approx(2.5)


def test_the_interval_of_a_mean_covers_it() -> None:
    draw = np.random.default_rng(1)
    hits = 0
    for k in range(200):
        _, low, high = mean_interval(draw.exponential(1.0, 100), seed=k)
        hits += low <= 1.0 <= high
    assert 180 <= hits <= 198  # 95 % of 200, a little less for so skewed a distribution


def test_pairs_show_what_means_hide() -> None:
    draw = np.random.default_rng(2)
    difficulty = draw.normal(0.0, 10.0, 50)
    mean, low, high = paired_difference(difficulty - 0.5 + draw.normal(0.0, 0.1, 50), difficulty)
    assert mean == pytest.approx(-0.5, abs=0.1)
    assert high < 0.0
    assert low > -0.7


@pytest.mark.parametrize("arms", list(SETS))
def test_everyone_drives_the_same_arms(arms: str) -> None:
    arm = Arm.load("thesis")
    seen = [roll_out(make_controller(name, arm, INTERVAL), TASKS["damp"], arm, SETS[arms], 5) for name in ("pd", "pd", "lqg")]
    assert np.array_equal(seen[0].tip, seen[1].tip)
    assert np.array_equal(seen[0].start, seen[2].start)
    assert not np.array_equal(seen[0].tip, seen[2].tip)


def test_more_arms_leave_the_first_ones_as_they_were() -> None:
    few, many = (evaluate_controller("vibration_dual", "slew", "randomised", Arm.load("thesis"), n) for n in (3, 8))
    for name in MEASURES:
        assert np.array_equal(few[name], many[name][:3])


def test_one_command_writes_the_table(tmp_path, capsys) -> None:
    assert main(["--controllers", "pd", "lqg", "--count", "4", "--jobs", "1", "--save", str(tmp_path)]) == 0
    result = json.loads((tmp_path / "baselines.json").read_text())
    assert set(result["cells"]) == {"slew", "track", "damp"}
    cell = result["cells"]["slew"]["nominal"]["lqg"]["steady_error"]
    assert cell["low"] <= cell["mean"] <= cell["high"]
    assert cell["less_than_pd"]["low"] > 5.0  # friction leaves PD about 8° short (thesis Fig. 2.6)
    table = (tmp_path / "baselines.md").read_text()
    assert "slew, randomised" in table
    assert "`lqg`" in table


@pytest.mark.parametrize(
    ("arguments", "word"), [(["--controllers", "pdd"], "'pd'"), (["--count", "0"], "--count"), (["--arm", "thesys"], "thesis")]
)
def test_bad_arguments_give_one_line(arguments: list[str], word: str, capsys) -> None:
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert word in error
    assert error.count("\n") == 1
