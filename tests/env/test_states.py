"""An environment goes back to a state bit for bit, and starts at a given state and target."""

from __future__ import annotations

import copy
import math
import pickle

import gymnasium as gym
import numpy as np
import pytest
from env_steps import TROUBLE, actions, same, steps_of, steps_of_many

from flexarm_env import Arm, InputError
from flexarm_env.env import FlexArmEnv
from flexarm_env.registration import IDS

NATIVE = {"vectorization_mode": "vector_entry_point"}


def make(id: str = "FlexArm/Slew-v0", **arguments: object) -> FlexArmEnv:
    env = gym.make(id, **arguments).unwrapped
    assert isinstance(env, FlexArmEnv)
    return env


@pytest.mark.parametrize("id", IDS)
def test_a_round_trip_changes_no_bit(id: str) -> None:
    arguments = {"disturb": TROUBLE, "duration": 0.6, "vary": {"hub.inertia": 0.1}}
    env, taken = make(id, **arguments), actions(250, 1)[:, 0]
    env.reset(seed=5)
    steps_of(env, taken[:50])
    state = env.state()
    expected = steps_of(env, taken[50:])
    assert env.state() != state
    env.set_state(state)
    assert env.state() == state
    assert same(steps_of(env, taken[50:]), expected)
    fresh = make(id, **arguments)
    fresh.set_state(pickle.loads(pickle.dumps(copy.deepcopy(state))))
    assert same(steps_of(fresh, taken[50:]), expected)
    assert fresh.drawn_arm() == env.drawn_arm()
    again = gym.make(id, **arguments)
    again.reset(options={"state": state})
    assert same(steps_of(again.unwrapped, taken[50:]), expected)


def test_many_arms_go_back_to_a_state() -> None:
    envs = gym.make_vec("FlexArm/Track-Random-v0", 5, max_episode_steps=25, disturb=TROUBLE, **NATIVE)
    envs.reset(seed=5)
    taken = actions(80, 5)
    steps_of_many(envs, taken[:25])  # all wait for a reset
    state = envs.unwrapped.state()
    expected = steps_of_many(envs, taken[25:])
    envs.unwrapped.set_state(state)
    assert same(steps_of_many(envs, taken[25:]), expected)
    observations, _ = envs.reset(options={"state": state})
    assert same(observations, state.numbers["observations"])
    assert same(steps_of_many(envs, taken[25:]), expected)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"id": "FlexArm/Damp-v0"}, "state of another environment"),
        ({"arm": "thesis-fem"}, "thesis-fem"),
        ({"arm": Arm.load("thesis").with_values({"hub.inertia": 0.3})}, "state of another environment"),
        ({"control_rate": 100.0}, "state of another environment"),
        ({"disturb": TROUBLE}, "state of another environment"),
        ({"physical": True}, "state of another environment"),
        ({"randomise": {"payload.mass": (0.0, 0.2)}}, "state of another environment"),
    ],
)
def test_a_state_of_another_environment_is_refused(arguments: dict, words: str) -> None:
    other, env = make(**arguments), make()
    other.reset(seed=0)
    env.reset(seed=0)
    before = env.state()
    with pytest.raises(InputError, match=words) as caught:
        env.set_state(other.state())
    assert "\n" not in str(caught.value)
    assert env.state() == before
    with pytest.raises(InputError, match=r"env\.unwrapped\.state"):
        env.set_state(np.zeros(8))


def test_there_is_no_state_before_the_first_reset() -> None:
    for env in (make(), gym.make_vec("FlexArm/Slew-v0", 2, **NATIVE).unwrapped):
        with pytest.raises(gym.error.ResetNeeded, match="state before reset"):
            env.state()


def test_a_state_of_other_arms_is_refused() -> None:
    three, two = (gym.make_vec("FlexArm/Slew-v0", n, **NATIVE).unwrapped for n in (3, 2))
    three.reset(seed=0)
    with pytest.raises(InputError, match="state of 3 arms; this environment has 2"):
        two.set_state(three.state())
    with pytest.raises(InputError, match="reset_mask beside a State"):
        three.reset(options={"state": three.state(), "reset_mask": np.array([True, False, False])})


def test_an_episode_starts_at_a_given_state() -> None:
    env = make(physical=True)
    env.reset(seed=0)
    start = env.state().physical.copy()
    start[0] = 0.7
    observation, info = env.reset(seed=3, options={"state": start, "target": -0.2})
    assert info["hub_angle"] == pytest.approx(0.7)
    assert info["target"] == -0.2
    assert observation[-1] == np.float32(-0.2)
    assert observation[0] == pytest.approx(0.7, abs=0.05)
    assert same(env.state().physical[0], 0.7)
    info = env.step(np.zeros(1))[4]
    assert info["reward_distance"] == pytest.approx(-0.9, abs=1e-3)
    moving = start.copy()
    moving[len(start) // 2] = 2.0
    info = env.reset(options={"state": moving})[1]
    assert (info["hub_speed"], info["stuck"]) == (pytest.approx(2.0), False)
    assert env.reset()[1]["hub_angle"] == 0.0  # the next episode starts as the task does


def test_single_and_many_arms_start_alike() -> None:
    one, many = (
        make("FlexArm/Track-Random-v0", disturb=TROUBLE),
        gym.make_vec("FlexArm/Track-Random-v0", 2, disturb=TROUBLE, **NATIVE),
    )
    many.reset(seed=0)
    start = many.unwrapped.state().physical
    start[:, 0] = (0.1, -0.3)
    options = {"state": start, "target": [0.2, 0.4]}
    first, _ = many.reset(seed=[7, 8], options=options)
    second, _ = one.reset(seed=8, options={"state": start[1], "target": 0.4})
    assert same(first[1], second)
    for action in actions(260, 2):
        assert same(many.step(action)[0][1], one.step(action[1])[0])


def test_a_target_changes_its_sign_in_turn() -> None:
    env = make("FlexArm/Track-v0")
    info = env.reset(seed=0, options={"target": 0.3})[1]
    targets = [info["target"]]
    for _ in range(1100):
        targets.append(env.step(np.zeros(1))[4]["target"])
    half = round(env.setup.task.half_period * 200.0)
    assert targets == [0.3 * (-1.0) ** (k // half) for k in range(1101)]
    info = env.reset(options={"state": env.state(), "target": 0.1})[1]
    assert info["target"] == math.copysign(0.1, targets[-1])
    assert env.step(np.zeros(1))[4]["target"] == info["target"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"targets": 0.1}, "unknown option 'targets'; did you mean 'target'"),
        ({"low": -1}, "unknown option 'low'; allowed: state, target"),
        ("abc", "give a dict with any of state, target"),
        ({"target": math.nan}, "finite"),
        ({"target": 1e3}, "from -12.57 to 12.57 rad"),
        ({"target": "far"}, "'far'"),
        ({"target": [0.1, 0.2]}, "shape"),
        ({"state": np.zeros(3)}, "shape"),
        ({"state": "rest"}, "'rest'"),
        ({"state": np.full(8, np.inf)}, "finite"),
        ({"state": np.full(8, 1e200)}, "no arm moves"),
        ({"state": 1e308 * np.eye(8)[0]}, "no arm moves"),
        ({"target": "0.3"}, "'0.3'"),
        ({"target": 10**400}, "in numbers"),
        ({"target": [[0.1], [0.1, 0.2]]}, "in numbers"),
    ],
)
def test_bad_options_give_one_clear_line(options: object, words: str) -> None:
    env = make()
    env.reset(seed=0)
    if isinstance(options, dict) and isinstance(options.get("state"), np.ndarray) and len(options["state"]) == 8:
        options = {"state": np.resize(options["state"], env.state().physical.shape)}
    with pytest.raises(InputError) as caught:
        env.reset(options=options)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("id", ["FlexArm/Slew-v0", "FlexArm/Slew-Random-v0"])
def test_a_refused_reset_changes_nothing(id: str) -> None:
    one, many = make(id, disturb=TROUBLE), gym.make_vec(id, 3, disturb=TROUBLE, **NATIVE)
    taken = actions(60, 3)
    one.reset(seed=0)
    many.reset(seed=0)
    steps_of(one, taken[:20, 0])
    steps_of_many(many, taken[:20])
    before, all_before = one.state(), many.unwrapped.state()
    lost, partly = before.physical.copy(), all_before.physical.copy()
    lost[2] = partly[1, 2] = 1e30
    partly[0, 0] = 1.0
    refused = [{"options": {"state": lost}, "seed": 5}, {"options": {"state": lost}}, {"seed": -1}]
    all_refused = [{"options": {"state": partly}, "seed": 5}, {"options": {"state": partly}}, {"seed": [1, 2, "a"]}]
    for arguments, for_all in zip(refused, all_refused, strict=True):
        with pytest.raises(InputError):
            one.reset(**arguments)
        with pytest.raises(InputError):
            many.reset(**for_all)
        assert one.state() == before
        assert many.unwrapped.state() == all_before
    expected = steps_of(one, taken[20:, 0]), one.reset(), steps_of_many(many, taken[20:]), many.reset()
    one.set_state(before)
    many.unwrapped.set_state(all_before)
    assert same((steps_of(one, taken[20:, 0]), one.reset(), steps_of_many(many, taken[20:]), many.reset()), expected)


def test_a_seed_beside_a_state_is_refused() -> None:
    env = make()
    env.reset(seed=0)
    with pytest.raises(InputError, match="seed beside a state"):
        env.reset(seed=1, options={"state": env.state()})
    envs = gym.make_vec("FlexArm/Slew-v0", 2, **NATIVE)
    envs.reset(seed=0)
    with pytest.raises(InputError, match="unknown option 'mask'; allowed: reset_mask, state, target"):
        envs.reset(options={"mask": np.ones(2, dtype=bool)})
