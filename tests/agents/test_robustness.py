"""Robustness: what each set changes, failures by mean and worst tenth, one command to the tables."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from agents import robustness as command
from agents.goals import cell_of as compared_cell
from agents.learning.plan_file import read_table
from agents.learning.run import train
from agents.robustness import cell_of, verdict_of
from flexarm_env import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import MEASURES
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.score import cost, worst_tenth
from flexarm_env.trials.sets import ROBUSTNESS, SETS, ArmSet

INTERVAL = 0.005


class Recorder:
    """Sends fixed commands and keeps what it saw."""

    def __init__(self, commands):
        self.commands, self.seen = commands, []

    def reset(self, count=None):
        self.seen = []

    def action(self, observation):
        self.seen.append(np.array(observation))
        return np.full((len(observation), 1), self.commands[len(self.seen) - 1], dtype=np.float32)


def driven(arms: ArmSet, commands=None):
    agent = Recorder([0.5] * 2000 if commands is None else commands)
    seen = roll_out(agent, TASKS["slew"], Arm.load("thesis"), arms, 2)
    return np.array(agent.seen), seen


@pytest.mark.parametrize(("name", "signal"), [("gage_lost", "strain_base"), ("tach_lost", "motor_speed")])
def test_a_lost_sensor_reads_zero_and_the_others_do_not(name, signal) -> None:
    lost, _ = driven(ROBUSTNESS[name])
    whole, _ = driven(ROBUSTNESS["randomised"])
    place = list(Arm.load("thesis").signals).index(signal)
    assert not lost[:, :, place].any()
    others = [i for i in range(5) if i != place]
    np.testing.assert_array_equal(lost[:, :, others], whole[:, :, others])


def test_a_delay_of_two_samples_shifts_what_the_arm_does() -> None:
    commands = np.concatenate([[0.8] * 40, [0.0] * 2000])
    late, prompt = driven(ROBUSTNESS["delay_10ms"], commands)[1], driven(ROBUSTNESS["randomised"], commands)[1]
    np.testing.assert_allclose(late.tip[2:], prompt.tip[:-2], atol=1e-9)


def test_half_the_rate_halves_the_samples() -> None:
    half, whole = driven(ROBUSTNESS["half_rate"])[1], driven(ROBUSTNESS["randomised"])[1]
    assert 2 * len(half.tip) == len(whole.tip) == 1000
    assert half.interval == 2.0 * whole.interval


def test_the_sets_of_the_published_tables_are_as_they_were() -> None:
    assert list(SETS) == ["nominal", "randomised", "disturbed"]
    assert all(not found.effects and not found.lost and found.rate_share == 1.0 for found in SETS.values())
    assert ROBUSTNESS["constants_30"].constants == 0.3


def test_the_worst_tenth_of_failures_shows_what_the_middle_half_hides() -> None:
    values = {name: np.ones((1, 100)) for name in MEASURES}
    values["unsettled"] = np.where(np.arange(100) < 5, 100.0, 0.0)[None]
    found = cell_of(values)["unsettled"]
    assert found["mean"]["value"] == 5.0
    assert found["worst_tenth"]["value"] == 50.0
    assert found["mean"]["low"] < 5.0 < found["mean"]["high"]
    compared = compared_cell(values)
    assert compared["unsettled"]["mean"] == 5.0
    assert compared["unsettled"]["worst_tenth"] == 50.0


def test_the_worst_tenth_of_a_known_sample() -> None:
    values = np.random.default_rng(0).permutation(np.arange(1000.0))
    assert worst_tenth(values) == pytest.approx(np.arange(900, 1000).mean())
    assert worst_tenth(np.arange(25.0)) == pytest.approx((24.0 + 23.0 + 0.5 * 22.0) / 2.5)


def test_the_best_of_each_kind_are_compared() -> None:
    def made(size: float) -> dict[str, np.ndarray]:
        return {name: np.full((1, 8), size) for name in MEASURES}

    found = verdict_of({"pd": made(4.0), "lqg": made(2.0), "good": made(1.0), "bad": made(9.0)}, ["good", "bad"])
    assert (found["policy"], found["controller"]) == ("good", "lqg")
    assert found["less_by"] == pytest.approx(0.5)
    assert found["probability"]["cost"]["value"] == 1.0
    assert verdict_of({"pd": made(1.0)}, []) is None
    assert cost(made(1.0)).shape == (1, 8)


def test_a_controller_is_made_for_the_rate_at_which_it_runs() -> None:
    arm, arms = Arm.load("thesis"), ROBUSTNESS["half_rate"]
    found = command.evaluate_any("lqg", "slew", "half_rate", arm, 2, 0)
    seen = roll_out(make_controller("lqg", arm, 2.0 * INTERVAL), TASKS["slew"], arm, arms, 2, first_seed=0)
    assert found["steady_error"][0] == pytest.approx(np.rad2deg(np.abs(seen.tip - seen.target)[-50:].mean(axis=0)))


def test_one_command_writes_the_tables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "ROBUSTNESS", {name: ROBUSTNESS[name] for name in ("randomised", "half_rate")})
    plan = {"at_once": 2, "actions": 20, "network": {"layers": [4]}, "learning": {"batch_size": 20}, "interface": {"repeat": 100}}
    train(read_table(plan), 0, None, lambda share, text: None).save(tmp_path / "weights" / "tiny-0.safetensors")
    arguments = ["pd", "tiny", "--policies", str(tmp_path / "weights"), "--save", str(tmp_path), "--count", "3", "--jobs", "1"]
    assert command.main([*arguments, "--development"]) == 0
    result = json.loads((tmp_path / "robustness.json").read_text())
    assert result["seed"] == 800_000_000
    assert set(result["cells"]["half_rate"]) == {"pd", "tiny"}
    table = (tmp_path / "robustness.md").read_text()
    assert "seed 800000000" in table
    assert "half the control rate" in table


@pytest.mark.parametrize(("arguments", "word"), [(["pdd"], "did you mean 'pd'"), (["pd", "--count", "0"], "--count")])
def test_bad_arguments_give_one_line(arguments, word, capsys) -> None:
    assert command.main(arguments) == 2
    error = capsys.readouterr().err
    assert word in error
    assert error.count("\n") == 1
