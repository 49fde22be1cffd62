"""Stable-Baselines3 trains on the environments as they are."""

from __future__ import annotations

import warnings

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from sb3_contrib import RecurrentPPO
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.vec_env import DummyVecEnv

from flexarm_env.registration import IDS
from flexarm_env.sb3 import make_vec


@pytest.mark.parametrize("id", IDS)
def test_the_checker_of_sb3_is_silent(id: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make(id).unwrapped)


@pytest.mark.parametrize("id", IDS)
def test_make_vec_and_dummy_vec_env_give_the_same(id: str) -> None:
    ours = make_vec(id, 4, seed=3, max_episode_steps=30)
    theirs = DummyVecEnv([lambda: gym.make(id, max_episode_steps=30)] * 4)
    theirs.seed(3)
    assert np.array_equal(ours.reset(), theirs.reset())
    draw, over = np.random.default_rng(0), 0
    for _ in range(70):
        action = draw.uniform(-1.0, 1.0, (4, 1)).astype(np.float32)
        first, second = ours.step(action), theirs.step(action)
        for one, two in zip(first[:3], second[:3], strict=True):
            assert np.array_equal(one, two)
        for one, two in zip(first[3], second[3], strict=True):
            assert ("terminal_observation" in one) == ("terminal_observation" in two)
            if "terminal_observation" in one:
                over += 1
                assert np.array_equal(one["terminal_observation"], two["terminal_observation"])
                assert one["TimeLimit.truncated"] == two["TimeLimit.truncated"]
                assert one["episode"]["l"] == 30
    assert over == 8


@pytest.mark.slow
@pytest.mark.parametrize(
    ("algorithm", "policy", "options"),
    [
        (PPO, "MlpPolicy", {"n_steps": 64, "batch_size": 64}),
        (SAC, "MlpPolicy", {"learning_starts": 64, "batch_size": 32}),
        (RecurrentPPO, "MlpLstmPolicy", {"n_steps": 64, "batch_size": 64}),
    ],
)
@pytest.mark.parametrize("single", [True, False])
def test_algorithms_train(algorithm: type, policy: str, options: dict, single: bool) -> None:
    env = gym.make("FlexArm/Slew-v0") if single else make_vec("FlexArm/Slew-v0", 4)
    model = algorithm(policy, env, seed=0, device="cpu", **options)
    model.learn(256)
    assert model.num_timesteps >= 256
