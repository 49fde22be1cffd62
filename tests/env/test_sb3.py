"""Stable-Baselines3 trains on the environments as they are."""

from __future__ import annotations

import copy
import json
import pickle
import warnings
from pathlib import Path

import cloudpickle
import gymnasium as gym
import numpy as np
import pytest
from env_steps import TROUBLE, actions, same

pytest.importorskip("stable_baselines3")
from sb3_contrib import RecurrentPPO
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv, VecMonitor, VecNormalize

from flexarm_env import InputError
from flexarm_env.env.infos import Infos, Step
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
            extra = {"episode"} if "terminal_observation" in one else set()
            assert one.keys() - extra == two.keys()
            assert all(same(one[name], two[name]) for name in two)
            assert ("terminal_observation" in one) == ("terminal_observation" in two)
            if "terminal_observation" in one:
                over += 1
                assert np.array_equal(one["terminal_observation"], two["terminal_observation"])
                assert one["TimeLimit.truncated"] == two["TimeLimit.truncated"]
                assert one["episode"]["l"] == 30
    assert over == 8
    assert same(ours.reset_infos, theirs.reset_infos)


class Zero:
    """A policy without a command."""

    def predict(self, observation, state=None, episode_start=None, deterministic=False):
        return np.zeros((len(observation), 1), dtype=np.float32), state


def test_statistics_of_episodes_are_those_of_a_monitor() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ours = evaluate_policy(Zero(), make_vec("FlexArm/Damp-v0", 2, seed=3, duration=0.2), 4, return_episode_rewards=True)
    theirs = DummyVecEnv([lambda: Monitor(gym.make("FlexArm/Damp-v0", duration=0.2))] * 2)
    theirs.seed(3)
    returns, lengths = evaluate_policy(Zero(), theirs, 4, return_episode_rewards=True)
    assert ours[1] == lengths
    assert ours[0] == pytest.approx(returns, abs=1e-5)
    assert make_vec("FlexArm/Damp-v0", 2).env_is_wrapped(VecMonitor) == [False, False]


def test_a_vec_monitor_keeps_terms_of_the_reward() -> None:
    vec = make_vec("FlexArm/Damp-v0", 2, seed=0, duration=0.1)
    with pytest.warns(UserWarning, match="VecMonitor"):  # the statistics are there already
        vec = VecMonitor(vec, info_keywords=("reward_vibration", "hub_angle"))
    vec = VecNormalize(vec)
    vec.reset()
    for _ in range(20):
        _, _, done, infos = vec.step(np.zeros((2, 1)))
    assert done.all()
    for info in infos:
        assert info["episode"]["reward_vibration"] == info["reward_vibration"] < 0.0
        assert info["episode"]["l"] == 20


def test_an_info_is_a_dict() -> None:
    outcome = np.array([[1.0, 2.0], [3.0, 4.0]])

    def infos() -> Infos:
        step = Step({"t": False}, outcome, {"a": 0, "b": 1}, lambda column: dict(zip("ab", column, strict=True)))
        found = Infos(step)
        found[1] |= {"b": 9.0, "c": 5.0}
        return found

    first, second = {"t": False, "a": 1.0, "b": 3.0}, {"t": False, "a": 2.0, "b": 9.0, "c": 5.0}
    readings = [
        lambda info: dict(info),
        lambda info: {**info},
        lambda info: {} | info,
        lambda info: info | {},
        lambda info: dict(info.items()),
        lambda info: dict(zip(info.keys(), info.values(), strict=True)),
        lambda info: {key: info[key] for key in info},
        lambda info: info.copy(),
        lambda info: copy.copy(info),
        lambda info: copy.deepcopy(info),
        lambda info: pickle.loads(pickle.dumps(info)),
        lambda info: json.loads(json.dumps(info)),
        lambda info: eval(repr(info)),
    ]
    for read in readings:
        assert [read(info) for info in infos()] == [first, second]
        assert list(map(len, infos())) == [3, 4]
    info = infos()[1]
    assert ("a" in info, "c" in info, "d" in info) == (True, True, False)
    assert (info.get("d"), info.get("c"), info.get("b"), info.get("a")) == (None, 5.0, 9.0, 2.0)
    info = infos()[1]
    with pytest.raises(KeyError, match="d"):
        info["d"]
    assert (info["a"], info["b"], info.pop("a"), info.get("a"), "a" in info) == (2.0, 9.0, 2.0, None, False)
    assert infos()[0] == first
    assert infos()[0] != second
    assert infos()[:1] == [first]
    assert infos()[-1] is not None
    assert pickle.loads(pickle.dumps(infos())) == [first, second]
    with pytest.raises(IndexError):
        infos()[2]


@pytest.mark.parametrize(
    "copied", [copy.deepcopy, lambda v: pickle.loads(pickle.dumps(v)), lambda v: cloudpickle.loads(cloudpickle.dumps(v))]
)
def test_a_copy_of_the_adapter_goes_on(copied) -> None:
    vec, taken = make_vec("FlexArm/Slew-Random-v0", 4, seed=3, disturb=TROUBLE, max_episode_steps=30), actions(80, 4)
    vec.reset()
    for action in taken[:20]:
        vec.step(action)
    other = copied(vec)
    for action in taken[20:]:
        for one, two in zip(vec.step(action)[:3], other.step(action)[:3], strict=True):
            assert np.array_equal(one, two)
    assert other.returns.tolist() == vec.returns.tolist()
    assert 0.0 <= other.began - vec.began + 60.0 <= 120.0


def test_processes_train_on_the_environment_that_they_are_sent() -> None:
    env = gym.make("FlexArm/Slew-Random-v0", disturb=TROUBLE)
    here, taken = DummyVecEnv([lambda: copy.deepcopy(env)]), actions(40, 1)
    there = SubprocVecEnv([lambda: env], start_method="spawn")
    for vec in (here, there):
        vec.seed(4)
    assert np.array_equal(here.reset(), there.reset())
    for action in taken:
        one, two = here.step(action), there.step(action)
        assert np.array_equal(one[0], two[0])
        assert np.array_equal(one[1], np.float32(two[1]))
        assert one[1][0] != 0.0
    there.close()


def test_options_of_a_reset_reach_the_arms() -> None:
    vec = make_vec("FlexArm/Slew-v0", 2, seed=0, physical=True)
    vec.set_options({"target": 0.25})
    assert vec.reset()[:, -1].tolist() == [0.25, 0.25]
    vec.set_options([{"target": 0.25}, {"target": 0.5}])
    assert vec.reset()[:, -1].tolist() == [0.25, 0.5]
    assert vec.reset()[0, -1] == np.float32(np.deg2rad(100.0))
    vec.set_options([{"target": 0.25}, {}])
    with pytest.raises(InputError, match="different names"):
        vec.reset()


@pytest.mark.parametrize("seed", ["a", -1, 2**64 - 1, 1.5])
def test_a_seed_that_is_none_is_refused(seed: object) -> None:
    with pytest.raises(InputError, match=r"seed.* = .*; give a whole number"):
        make_vec("FlexArm/Slew-v0", 2, seed=seed)


def test_arms_are_drawn_beside_each_other(tmp_path: Path) -> None:
    pytest.importorskip("pygame")
    vec = make_vec("FlexArm/Slew-v0", 4, seed=0, render_mode="rgb_array")
    vec.reset()
    each = vec.get_images()
    assert len(each) == 4
    assert vec.metadata["render_fps"] == 200  # for VecVideoRecorder
    assert vec.render().shape == (2 * each[0].shape[0], 2 * each[0].shape[1], 3)
    assert make_vec("FlexArm/Slew-v0", 2).get_images() == [None, None]


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


@pytest.mark.parametrize(
    ("id", "words"),
    [
        ("FlexArm/Slw-v0", "no environment 'FlexArm/Slw-v0'; did you mean 'FlexArm/Slew-v0'?"),
        ("Slew-Goal-v0", "no environment 'Slew-Goal-v0'; did you mean 'FlexArm/Slew-Goal-v0'?"),
        ("FlexArm/Slew-v9", "no environment 'FlexArm/Slew-v9'; did you mean 'FlexArm/Slew-v0'?"),
        ("FlexArm/Slew v0", "no environment 'FlexArm/Slew v0'; did you mean 'FlexArm/Slew-v0'?"),
        (3, "no environment 3; allowed: FlexArm/Damp-Goal-v0, "),
        ("CartPole-v1", "'CartPole-v1' is no environment of arms; allowed: FlexArm/Damp-v0, "),
        ("Pendulum-v1", "'Pendulum-v1' is no environment of arms; allowed: FlexArm/Damp-v0, "),
    ],
)
def test_an_id_of_no_arms_is_refused_in_one_line(id, words: str) -> None:
    with pytest.raises(InputError) as refusal:
        make_vec(id, 2)
    assert str(refusal.value).startswith(words)
    assert "\n" not in str(refusal.value)


def test_an_id_that_names_its_module_is_taken() -> None:
    vec = make_vec("flexarm_env:FlexArm/Slew-v0", 2)
    assert vec.num_envs == 2
    vec.close()
