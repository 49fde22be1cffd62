"""Arms to train on: those with late commands beside others, and with play in the gears."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from small_plans import silent, small

from agents.learning.episodes import EpisodeVecEnv
from agents.learning.run import train
from flexarm_env import Arm
from flexarm_env.vector_env import FlexArmVectorEnv
from flexarm_env.wrappers.arms import draws_of
from flexarm_env.wrappers.registered import roomy

DELAYS = [0.0, 0.0025, 0.01]
ARMS = {"delays": DELAYS, "backlash": 0.02, "tap_rate": 0.0, "dropout_rate": 0.0}


def test_each_delay_has_its_share_of_the_arms() -> None:
    plan = small(at_once=7, arms=ARMS, interface={"repeat": 4, "estimate": False, "lags": [0]})
    arm = Arm.load("thesis")
    env = EpisodeVecEnv(plan, arm, 2)
    assert [group.num_envs for group in env.groups] == [3, 2, 2]
    assert [dict(group.arms.setup.arm.effects).get("input_delay") for group in env.groups] == [
        None,
        {"delay": 0.0025},
        {"delay": 0.01},
    ]
    seen = env.reset()
    width = env.interface.size
    assert seen[:, -1].tolist() == pytest.approx([0.0, 0.0, 0.0, 0.25, 0.25, 1.0, 1.0])  # for the critic alone
    action = np.ones((7, 1))
    for _ in range(2):
        env.step(action)
    alone = FlexArmVectorEnv(2, roomy(env.groups[2].arms.setup.task), arm.with_effect("input_delay", delay=0.01), physical=True,
                             **draws_of(plan.arms, arm))  # fmt: skip
    alone.reset(seed=2 * 10_000_000 + 5)
    for _ in range(8):
        alone.move(np.ones((2, 1), dtype=np.float32))
    assert np.array_equal(env.groups[2].batch.info()["hub_angle"], alone.batch.info()["hub_angle"])
    assert (env.groups[2].batch.info()["hub_angle"] < env.groups[0].batch.info()["hub_angle"].min()).all()
    assert env.groups[2].shaping.interface.arm == arm  # the policy believes in the arm without the delay
    assert width < seen.shape[1]


def test_play_is_drawn_for_each_episode() -> None:
    plan = small(at_once=4, arms=ARMS)
    env = EpisodeVecEnv(plan, Arm.load("thesis"), 0)
    env.reset()
    gaps = [group.batch.arm_of(i).effects["backlash"]["gap"] for group in env.groups for i in range(group.num_envs)]
    assert len(set(gaps)) == 4
    assert 0.0 < min(gaps) < max(gaps) <= 0.02


def test_a_policy_is_trained_on_all_of_them() -> None:
    made = train(small(at_once=4, arms=ARMS, actions=80, learning={"batch_size": 40, "epochs": 1}), 1, None, silent)
    assert made.run["actions"] == 80
    assert made.plan.arms.delays == tuple(DELAYS)
    assert made.agent().interface.size > 0
