"""Machines of one joint as environments: the same bits alone and in company, a state to go back to, a picture."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from one_joint import elastic_joint, pendulum, servo

#: The pendulum has no friction, and would turn over and over under a larger torque.
MACHINES = (pendulum().with_values({"drive.limit": 0.5}), elastic_joint(), servo())
every_machine = pytest.mark.parametrize("arm", MACHINES, ids=lambda arm: arm.name)


@every_machine
@pytest.mark.parametrize("task", ["Slew", "Damp", "Track"])
def test_a_machine_is_a_sound_environment(arm, task):
    check_env(gym.make(f"FlexArm/{task}-v0", arm=arm).unwrapped, skip_render_check=True)


@every_machine
def test_a_machine_moves_alike_alone_and_in_company(arm):
    single, many = gym.make("FlexArm/Track-v0", arm=arm), gym.make_vec("FlexArm/Track-v0", num_envs=3, arm=arm)
    seeds = [5, 6, 7]
    company, _ = many.reset(seed=seeds)
    alone, _ = single.reset(seed=seeds[1])
    for action in np.random.default_rng(1).uniform(-0.5, 0.5, 60).astype(np.float32):
        assert np.array_equal(company[1], alone)
        company, *_ = many.step(np.full((3, 1), action))
        alone, *_ = single.step(np.array([action]))


@every_machine
def test_a_machine_goes_back_to_a_state(arm):
    env = gym.make("FlexArm/Track-v0", arm=arm)
    env.reset(seed=2)
    env.step(np.array([0.4], dtype=np.float32))
    state = env.unwrapped.state()
    first = env.step(np.array([0.2], dtype=np.float32))[0]
    env.unwrapped.set_state(state)
    assert np.array_equal(env.step(np.array([0.2], dtype=np.float32))[0], first)


@every_machine
def test_a_servo_s_action_is_its_goal_and_any_command_a_share_of_the_limit(arm):
    env = gym.make("FlexArm/Track-v0", arm=arm)
    env.reset(seed=2)
    *_, info = env.step(np.array([0.5], dtype=np.float32))
    assert info["command"] == pytest.approx(0.5 * arm.constants["drive"]["limit"])


@every_machine
def test_a_machine_has_a_picture(arm):
    env = gym.make("FlexArm/Track-v0", arm=arm, render_mode="rgb_array")
    env.reset(seed=1)
    env.step(np.array([0.4], dtype=np.float32))
    picture = env.render()
    assert picture.ndim == 3
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 10
