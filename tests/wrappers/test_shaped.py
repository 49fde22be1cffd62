"""Environments with the observation, the action and the reward of the shipped policies."""

from __future__ import annotations

import copy
import math
import pickle
import warnings
from pathlib import Path

import cloudpickle
import gymnasium as gym
import numpy as np
import pytest
from env_steps import TROUBLE, same, steps_of
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from flexarm_env import Arm, InputError
from flexarm_env.registration import SHAPED
from flexarm_env.tasks import COMMON_TERMS
from flexarm_env.vector_env import FlexArmVectorEnv
from flexarm_env.wrappers import Shaped, ShapedVector
from flexarm_env.wrappers.registered import trained_on

every_id = pytest.mark.parametrize("id", SHAPED)
NATIVE = {"vectorization_mode": "vector_entry_point"}
HISTORY = {"lags": [0, 4], "command_lags": [0, 1], "estimate": False, "repeat": 4}


def taken(steps: int, arms: int, numbers: int) -> np.ndarray:
    return np.random.default_rng(3).uniform(-1.0, 1.0, (steps, arms, numbers)).astype(np.float32)


@every_id
def test_the_checkers_are_silent(id: str) -> None:
    sb3 = pytest.importorskip("stable_baselines3.common.env_checker")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sb3.check_env(gym.make(id, disable_env_checker=True))
        warnings.filterwarnings("ignore", ".*different from the unwrapped version")  # a wrapper is what is checked
        check_env(gym.make(id).env.env, skip_render_check=True)


@every_id
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize("arms", [1, 5])
def test_vector_and_single_arms_give_the_same_bits(id: str, arms: int, mode: AutoresetMode) -> None:
    arguments = {"disturb": TROUBLE, "max_episode_steps": 9}
    many = gym.make_vec(id, arms, autoreset_mode=mode, **NATIVE, **arguments)
    singles = SyncVectorEnv([lambda: gym.make(id, **arguments)] * arms, autoreset_mode=mode)
    assert same(many.reset(seed=5), singles.reset(seed=5))
    for action in taken(30, arms, many.single_action_space.shape[0]):
        for one, two in zip(many.step(action), singles.step(action), strict=True):
            assert same(one, two)


@every_id
def test_single_and_vec_env_of_sb3_give_the_same(id: str) -> None:
    vec_env = pytest.importorskip("stable_baselines3.common.vec_env")
    from flexarm_env.sb3 import make_vec

    ours, theirs = make_vec(id, 3, seed=2, duration=0.3), vec_env.DummyVecEnv([lambda: gym.make(id, duration=0.3)] * 3)
    theirs.seed(2)
    assert np.array_equal(ours.reset(), theirs.reset())
    ended = 0
    for action in taken(40, 3, ours.action_space.shape[0]):
        first, second = ours.step(action), theirs.step(action)
        assert all(np.array_equal(one, two) for one, two in zip(first[:3], second[:3], strict=True))
        for one, two in zip(first[3], second[3], strict=True):
            assert all(same(one[name], two[name]) for name in two)
            if "episode" in one:
                ended += 1
                assert one["episode"]["l"] == 15
    assert ended == 6


@pytest.mark.parametrize(
    "copied", [copy.deepcopy, lambda v: pickle.loads(pickle.dumps(v)), lambda v: pickle.loads(cloudpickle.dumps(v))]
)
@every_id
def test_a_copy_goes_on(id: str, copied) -> None:
    env, many = gym.make(id, duration=0.5), gym.make_vec(id, 3, **NATIVE, duration=0.5)
    steps = taken(50, 3, env.action_space.shape[0])
    env.reset(seed=1)
    many.reset(seed=1)
    for action in steps[:12]:
        env.step(action[0])
        many.step(action)
    other, others = copied(env), copied(many)
    assert same(steps_of(other, steps[12:, 0]), steps_of(env, steps[12:, 0]))
    for action in steps[12:]:
        assert same(others.step(action), many.step(action))
    assert not np.array_equal(other.step(steps[0, 0])[0], copied(other).step(-steps[0, 0])[0])  # it moves


@every_id
def test_a_registration_makes_an_equal_environment(id: str) -> None:
    env = gym.make(id, arm=Arm.load("thesis").with_effect("backlash", gap=0.02), interface={"repeat": 5}, duration=1.0)
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert again.unwrapped.setup.arm == env.unwrapped.setup.arm
    assert same(env.reset(seed=4), again.reset(seed=4))
    action = np.full(env.action_space.shape, 0.5, dtype=np.float32)
    assert same(env.step(action), again.step(action))


def test_an_action_is_held_and_a_pulse_is_not() -> None:
    bare, env = (gym.make("FlexArm/Slew-v0", physical=True) for _ in range(2))
    env = Shaped(env, {**HISTORY, "authority": 0.5, "pulse": 0.25}, reward=None)
    bare.reset(seed=0)
    env.reset(seed=0)
    commands, rewards = [0.5 * 0.4 + 0.25, 0.2, 0.2, 0.2], 0.0
    for command in commands:
        seen, reward, *_, info = bare.step(np.array([command], dtype=np.float32))
        rewards += reward
    found = env.step(np.array([0.4, 1.0], dtype=np.float32))
    assert found[1] == pytest.approx(rewards, rel=1e-12)
    assert same(found[4], info)
    shown = np.sinh(3.0 * found[0][1]) * 0.1  # the motor's speed, on the scale of features
    assert shown == pytest.approx(seen[1], abs=1e-4)
    assert found[0][-2:] == pytest.approx([0.2, 0.2], abs=1e-6)


def test_an_episode_has_the_actions_of_its_seconds() -> None:
    env = gym.make("FlexArm/Track-Shaped-v0")
    env.reset(seed=0)
    idle, count, over = np.zeros(env.action_space.shape, dtype=np.float32), 0, False
    while not over:
        _, _, terminated, truncated, _ = env.step(idle)
        count, over = count + 1, terminated or truncated
    assert (count, terminated) == (10.0 * 200 / 4, False)


def test_the_ids_are_what_the_policies_were_trained_on() -> None:
    pytest.importorskip("stable_baselines3")
    from agents.learning.episodes import EpisodeVecEnv
    from agents.learning.plan_file import read_plan

    project = Path(__file__).parents[2]
    for task in ("slew", "track", "damp"):
        plan = read_plan(project / "configs" / "agents" / f"ppo_{task}.toml")
        assert trained_on(task).interface == plan.interface
        arm = Arm.load(plan.arm)
        env = EpisodeVecEnv(plan, arm, 0)
        envs = gym.make_vec(f"FlexArm/{task.title()}-Shaped-v0", plan.at_once, **NATIVE)
        before, seen = env.reset(), envs.reset(seed=0)[0]
        width = seen.shape[1]
        assert np.array_equal(before[:, :width], seen)
        for action in taken(3, plan.at_once, plan.interface.actions):
            assert np.array_equal(env.step(action)[0][:, :width], envs.step(action)[0])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Shaped(gym.make("FlexArm/Slew-v0")), "physical=True"),
        (lambda: Shaped(gym.make("FlexArm/Slew-v0", physical=True), {"lag": [1]}), "'lags'"),
        (lambda: gym.make("FlexArm/Slew-Shaped-v0", reward={"near": -1.0}), "near = -1"),
        (lambda: gym.make("FlexArm/Slew-Shaped-v0", task="track"), "task = 'track'"),
        (lambda: gym.make("FlexArm/Slew-Shaped-v0", rate=3), "unexpected keyword"),
        (lambda: gym.make("FlexArm/Slew-Shaped-v0", prior="cu-flexible"), "other sensors"),
    ],
)
def test_what_makes_no_sense_is_refused_in_one_line(make, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        make()


@pytest.mark.parametrize("steps", [0, -3, 2.5, True, "9"])
def test_an_episode_of_no_actions_is_refused(steps) -> None:
    words = rf"^max_episode_steps = {steps!r}; give a whole number from 1 up$"
    with pytest.raises(InputError, match=words):
        ShapedVector(FlexArmVectorEnv(2, "slew", physical=True), max_episode_steps=steps)
    for id in ("FlexArm/Slew-Shaped-v0", "FlexArm/Slew-v0"):
        with pytest.raises(InputError, match=words):
            gym.make_vec(id, 2, max_episode_steps=steps, **NATIVE)


def test_resets_that_the_memory_cannot_follow_are_refused() -> None:
    env = gym.make("FlexArm/Slew-Shaped-v0")
    env.reset(seed=0)
    with pytest.raises(InputError, match="memory"):
        env.reset(options={"state": env.unwrapped.state()})
    start = env.unwrapped.state().physical.copy()
    start[0] = 0.5
    assert env.reset(options={"state": start, "target": 1.0})[1]["hub_angle"] == pytest.approx(0.5)
    many = gym.make_vec("FlexArm/Slew-Shaped-v0", 2, **NATIVE)
    many.reset(seed=0)
    with pytest.raises(InputError, match="start together"):
        many.reset(options={"reset_mask": np.array([True, False])})
    for action in (np.zeros((2, 1)), np.full((2, 2), math.nan)):
        with pytest.raises(InputError, match="finite numbers"):
            many.step(action)


def test_where_one_arm_leaves_its_range_all_episodes_end() -> None:
    many = ShapedVector(FlexArmVectorEnv(2, "slew", physical=True, autoreset_mode="Disabled"), {**HISTORY, "repeat": 20})
    many.reset(seed=0)
    for _ in range(50):
        *_, terminated, truncated, _ = many.step(np.array([[1.0], [0.0]]))
        if terminated.any():
            break
    assert (terminated.tolist(), truncated.tolist()) == ([True, False], [False, True])
    with pytest.raises(gym.error.ResetNeeded):
        many.step(np.zeros((2, 1)))


def test_goals_are_drawn_by_seed_within_their_range() -> None:
    envs = gym.make_vec("FlexArm/Slew-Goal-v0", 400, **NATIVE)
    envs.reset(seed=0)
    goals = envs.batch.info()["target"]
    assert -2.0 <= goals.min() < -1.9 < 1.9 < goals.max() <= 2.0
    assert abs(goals.mean()) < 4.0 * (4.0 / 12.0**0.5) / 400**0.5
    single = gym.make("FlexArm/Slew-Goal-v0")
    assert single.reset(seed=7)[1]["target"] == goals[7]
    assert single.reset()[1]["target"] != goals[7]
    assert gym.make("FlexArm/Slew-v0", goals=(0.5, 0.5)).reset(seed=0)[1]["target"] == 0.5
    for goals in (0.5, (1.0, 0.5), (0.0, math.nan), ("a", "b")):
        with pytest.raises(InputError, match="goals = "):
            gym.make("FlexArm/Slew-v0", goals=goals)


def test_the_own_reward_is_that_of_the_task() -> None:
    env = gym.make("FlexArm/Slew-Shaped-v0")
    assert {f"reward_{term.name}" for term in COMMON_TERMS} <= env.reset(seed=0)[1].keys()


@pytest.mark.parametrize("given", [3, "lags", [1]])
def test_options_that_are_no_table_are_refused(given) -> None:
    for name in ("interface", "reward"):
        with pytest.raises(InputError, match=f"{name} = .*; give a table"):
            gym.make("FlexArm/Slew-Shaped-v0", **{name: given})


def test_environments_without_arms_are_refused() -> None:
    with pytest.raises(InputError, match="not on CartPoleEnv"):
        Shaped(gym.make("CartPole-v1"))
    with pytest.raises(InputError, match="not on CartPoleVectorEnv"):
        ShapedVector(gym.make_vec("CartPole-v1", 2))
