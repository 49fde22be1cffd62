"""Libraries of others use the environments as they are. Those that are not installed are skipped by name."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from env_steps import actions, same
from gymnasium.utils.env_match import check_environments_match
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers import vector as of_many
from packaging.version import Version

from flexarm_env import Arm
from flexarm_env.registration import IDS

#: Warnings that a library has for itself.
theirs = pytest.mark.filterwarnings("default")
every_id = pytest.mark.parametrize("id", IDS)
NATIVE = {"vectorization_mode": "vector_entry_point"}


@every_id
def test_two_environments_of_gymnasium_match(id: str) -> None:
    check_environments_match(gym.make(id), gym.make(id), num_steps=60, seed=3)


@every_id
@pytest.mark.parametrize("render_mode", [None, "rgb_array"])
def test_the_passive_checker_of_gymnasium_is_silent(id: str, render_mode: str | None) -> None:
    if render_mode:
        pytest.importorskip("pygame")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gym.make(id, render_mode=render_mode, duration=0.05, disable_env_checker=False)
        for seed in (0, None):
            env.reset(seed=seed)
            for action in actions(10, 1)[:, 0]:
                result = env.step(action)
                assert env.observation_space.contains(result[0])
                if render_mode:
                    env.render()
            assert result[3]
        env.close()


@every_id
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_wrappers_of_gymnasium_take_many_arms(id: str, mode: AutoresetMode) -> None:
    """Gymnasium has no checker of vector environments; its wrappers rely on spaces, infos and metadata."""
    if mode is AutoresetMode.SAME_STEP and Version(gym.__version__) < Version("1.4"):
        pytest.skip("Gymnasium before 1.4 counts a step too few of episodes that start in the step that ends the last one")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bare = gym.make_vec(id, 3, duration=0.1, autoreset_mode=mode, **NATIVE)
        assert bare.metadata["autoreset_mode"] is mode
        assert bare.observation_space == gym.vector.utils.batch_space(bare.single_observation_space, 3)
        envs = of_many.RecordEpisodeStatistics(of_many.ClipAction(bare))
        envs.reset(seed=0)
        ended = 0
        for action in actions(60, 3):
            observations, _, terminated, truncated, infos = envs.step(action)
            assert observations in envs.observation_space
            done = terminated | truncated
            if done.any():
                assert (infos["episode"]["l"][done] == 20).all()
                ended += int(done.sum())
        assert ended >= 6


class Agent:
    """The network of CleanRL's PPO for continuous actions, small."""

    def __init__(self, torch: Any, sizes: tuple[int, int]) -> None:
        nn, (seen, acted) = torch.nn, sizes
        self.critic = nn.Sequential(nn.Linear(seen, 16), nn.Tanh(), nn.Linear(16, 1))
        self.actor = nn.Sequential(nn.Linear(seen, 16), nn.Tanh(), nn.Linear(16, acted))
        self.log_std = nn.Parameter(torch.zeros(1, acted))
        self.parameters = [*self.critic.parameters(), *self.actor.parameters(), self.log_std]
        self.normal = torch.distributions.Normal

    def evaluate(self, seen: Any, action: Any = None) -> tuple[Any, Any, Any]:
        mean = self.actor(seen)
        drawn = self.normal(mean, self.log_std.exp().expand_as(mean))
        action = drawn.sample() if action is None else action
        return action, drawn.log_prob(action).sum(1), self.critic(seen).flatten()


def wrapped(id: str) -> gym.Env:
    """The wrappers of CleanRL's ppo_continuous_action.py."""
    env = gym.wrappers.RecordEpisodeStatistics(gym.wrappers.FlattenObservation(gym.make(id, duration=0.1)))
    env = gym.wrappers.NormalizeObservation(gym.wrappers.ClipAction(env))
    env = gym.wrappers.TransformObservation(env, lambda seen: np.clip(seen, -10, 10), env.observation_space)
    return gym.wrappers.TransformReward(gym.wrappers.NormalizeReward(env), lambda reward: np.clip(reward, -10, 10))


@every_id
def test_the_ppo_of_cleanrl_trains(id: str) -> None:
    torch = pytest.importorskip("torch", reason="torch is not installed: no PPO in the manner of CleanRL")
    torch.manual_seed(0)
    envs = gym.vector.SyncVectorEnv([lambda: wrapped(id)] * 2, autoreset_mode=AutoresetMode.SAME_STEP)
    agent = Agent(torch, (envs.single_observation_space.shape[0], 1))
    optimiser = torch.optim.Adam(agent.parameters, lr=3e-3)
    seen, returns, before = torch.Tensor(envs.reset(seed=1)[0]), [], [p.detach().clone() for p in agent.parameters]
    for _ in range(2):
        steps = []
        for _ in range(32):
            with torch.no_grad():
                action, log_prob, value = agent.evaluate(seen)
            following, reward, terminated, truncated, info = envs.step(action.numpy())
            over = torch.Tensor(terminated | truncated)
            steps.append((seen, action, log_prob, value, torch.Tensor(reward), over))
            returns += list(info.get("final_info", {}).get("episode", {}).get("r", []))
            seen = torch.Tensor(following)
        gain = agent.evaluate(seen)[2].detach()
        rows = []
        for step in reversed(steps):
            gain = step[4] + 0.99 * gain * (1.0 - step[5])
            rows.append((*step[:4], gain))
        was_seen, action, log_prob, value, target = (torch.cat(column) for column in zip(*rows, strict=True))
        for _ in range(2):
            _, new, now = agent.evaluate(was_seen, action)
            ratio, advantage = (new - log_prob).exp(), (target - value) / (target - value).std()
            clipped = torch.min(ratio * advantage, ratio.clamp(0.8, 1.2) * advantage).mean()
            loss = 0.5 * (now - target).pow(2).mean() - clipped
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
    assert len(returns) >= 4
    assert all(torch.isfinite(p).all() for p in agent.parameters)
    assert any(not torch.equal(p, old) for p, old in zip(agent.parameters, before, strict=True))


@theirs
@every_id
def test_the_specs_of_torchrl_hold(id: str) -> None:
    envs = pytest.importorskip("torchrl.envs", reason="torchrl is not installed: no check_env_specs")
    check_env_specs = pytest.importorskip("torchrl.envs.utils").check_env_specs
    check_env_specs(envs.GymEnv(id))
    check_env_specs(envs.GymWrapper(gym.make(id)))
    skipping = envs.GymEnv(id, frame_skip=4)
    check_env_specs(skipping)
    assert skipping.rollout(5)["next", "observation"].shape == (5, 5)


@theirs
def test_rllib_trains() -> None:
    pytest.importorskip("ray.rllib", reason="ray[rllib] is not installed: no PPO of RLlib")
    from ray.rllib.algorithms.ppo import PPOConfig
    from ray.tune.registry import register_env

    register_env("flexarm", lambda arguments: gym.make("FlexArm/Slew-v0", duration=0.5, **arguments))
    config = PPOConfig().environment("flexarm").env_runners(num_env_runners=0)
    algorithm = config.training(train_batch_size_per_learner=200, minibatch_size=64, num_epochs=1).build_algo()
    try:
        assert np.isfinite(algorithm.train()["env_runners"]["episode_return_mean"])
    finally:
        algorithm.stop()


@theirs
def test_minari_stores_episodes_and_makes_the_environment_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    minari = pytest.importorskip("minari", reason="minari is not installed: no data set")
    for part in ("h5py", "jax"):
        pytest.importorskip(part, reason=f"{part} is not installed: no data set of minari[hdf5,create]")
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    arm = Arm.load("thesis").with_effect("backlash", gap=0.02)
    env = minari.DataCollector(gym.make("FlexArm/Slew-v0", arm=arm, duration=0.1), record_infos=True)
    seen = []
    for seed in range(2):
        seen.append([env.reset(seed=seed)[0]])
        seen[-1] += [env.step(action)[0] for action in actions(20, 1)[:, 0]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it asks for an author and the like
        data = env.create_dataset("flexarm/slew-v0", algorithm_name="random")
    assert (data.total_episodes, data.total_steps) == (2, 40)
    assert same([episode.observations for episode in data], [np.array(one) for one in seen])
    again = data.recover_environment()
    assert again.unwrapped.setup.arm == arm
    assert same(again.reset(seed=0)[0], seen[0][0])
