"""Training, and runs that are stopped."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

pytest.importorskip("stable_baselines3")
import torch
from small_plans import silent, small

from agents.learning.checkpoint import read_checkpoint
from agents.learning.episodes import EpisodeVecEnv
from agents.learning.models import make_model
from agents.learning.run import train
from agents.train import main
from flexarm_env import Arm, InputError


def test_only_the_critic_sees_the_truth() -> None:
    plan = small()
    env = EpisodeVecEnv(plan, Arm.load("thesis"), 0)
    model = make_model(plan, env, 0)
    seen = torch.as_tensor(env.reset())
    other = seen.clone()
    other[:, env.interface.size :] += 1.0
    policy = model.policy
    assert torch.equal(policy.get_distribution(seen).mode(), policy.get_distribution(other).mode())
    assert not torch.equal(policy.predict_values(seen), policy.predict_values(other))


def test_actions_that_are_to_stray_less_do() -> None:
    network = {"layers": [8], "spread": "falling", "log_std": -1.0, "last_log_std": -3.0}
    made = train(small(network=network), 0, None, silent)
    assert made.weights["log_std"].item() == pytest.approx(-2.0)  # set at the start of the second of two batches
    assert train(small(network=network | {"spread": "own"}), 0, None, silent).weights["spread_net.weight"].shape == (1, 8)


class Stop(Exception):
    pass


@pytest.mark.parametrize("algorithm", ["ppo", "recurrent_ppo"])
def test_a_stopped_run_ends_with_the_same_bits(algorithm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    plan = small(algorithm=algorithm, actions=100)
    whole = train(plan, 3, None, silent)

    def stop(share: float, text: str) -> None:
        if share >= 0.6:
            raise Stop

    with pytest.raises(Stop):
        train(plan, 3, tmp_path / "a.checkpoint", stop)
    resumed = train(plan, 3, tmp_path / "a.checkpoint", silent)
    assert resumed.weights.keys() == whole.weights.keys()
    for name, value in whole.weights.items():
        assert torch.equal(value, resumed.weights[name]), name
    assert resumed.run["curve"] == whole.run["curve"]


@pytest.mark.parametrize("algorithm", ["sac", "tqc"])
def test_an_off_policy_run_goes_on(algorithm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    plan = small(algorithm=algorithm, actions=100)

    def stop(share: float, text: str) -> None:
        if share >= 0.6:
            raise Stop

    with pytest.raises(Stop):
        train(plan, 3, tmp_path / "a.checkpoint", stop)
    assert train(plan, 3, tmp_path / "a.checkpoint", silent).run["actions"] >= 100


def test_a_checkpoint_of_another_plan_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    train(small(actions=60), 3, tmp_path / "a.checkpoint", silent)
    with pytest.raises(InputError, match="another plan"):
        train(small(actions=80), 3, tmp_path / "a.checkpoint", silent)


def test_a_checkpoint_of_another_arm_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Though its file has the same name."""
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    arm, place = Arm.load("thesis"), tmp_path / "a.checkpoint"
    arm.save(tmp_path / "arm.toml")
    plan = small(arm=str(tmp_path / "arm.toml"), actions=60)
    train(plan, 3, place, silent)
    arm.with_values({"hub.inertia": 0.3}).save(tmp_path / "arm.toml")
    with pytest.raises(InputError, match=r"a\.checkpoint is of another plan, arm, seed or version"):
        train(plan, 3, place, silent)
    arm.save(tmp_path / "arm.toml")
    monkeypatch.setattr("agents.learning.run.__version__", "0.0.0")
    with pytest.raises(InputError, match="version of FlexArm"):
        train(plan, 3, place, silent)


def test_a_damaged_checkpoint_is_refused_in_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    place = tmp_path / "a.checkpoint"
    train(small(), 3, place, silent)
    whole, draw = place.read_bytes(), random.Random(5)
    damaged = [b"", b"\0", b"a text\n", whole[:40], whole[: len(whole) // 2], whole[:-1], whole + b"\0"]
    for _ in range(40):
        flipped = bytearray(whole)
        flipped[draw.randrange(len(whole))] ^= 1 << draw.randrange(8)
        damaged.append(bytes(flipped))
    for content in damaged:
        place.write_bytes(content)
        with pytest.raises(InputError, match=r"a\.checkpoint is no checkpoint, or a damaged one; delete it") as caught:
            read_checkpoint(place)
        assert str(caught.value).isprintable()


def test_the_command_trains_what_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = tmp_path / "tiny.toml"
    config.write_text(
        "actions = 20\nat_once = 2\n[network]\nlayers = [4]\n[learning]\nbatch_size = 20\n[interface]\nrepeat = 100\n"
    )
    command = [str(config), "--seeds", "0", "--save", str(tmp_path / "made"), "--tensorboard", str(tmp_path / "board")]
    assert main(command) == 0
    assert main(command) == 0
    assert "is there already" in capsys.readouterr().out
    assert [path.name for path in (tmp_path / "made").iterdir()] == ["tiny-0.safetensors"]
    assert any((tmp_path / "board").rglob("events.*"))
