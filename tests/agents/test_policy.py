"""A policy sees, when it is evaluated, what it saw when it was trained."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from sb3_contrib import RecurrentPPO
from stable_baselines3 import PPO

from agents.policy import TrainedPolicy
from flexarm_env import Arm
from flexarm_env.sb3 import make_vec
from flexarm_env.tasks import TASKS
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.sets import FIRST_SEED, SETS


@pytest.mark.parametrize(("algorithm", "policy"), [(PPO, "MlpPolicy"), (RecurrentPPO, "MlpLstmPolicy")])
def test_a_policy_does_in_evaluation_what_it_does_in_its_env(algorithm: type, policy: str) -> None:
    model = algorithm(policy, make_vec("FlexArm/Slew-v0", 2), n_steps=8, batch_size=8, seed=1, device="cpu")
    arm = Arm.load("thesis")
    seen = roll_out(TrainedPolicy(model, TASKS["slew"], arm), TASKS["slew"], arm, SETS["nominal"], 1)
    env = gym.make("FlexArm/Slew-v0")
    observation, _ = env.reset(seed=FIRST_SEED)
    memory, start = None, np.ones(1, dtype=bool)
    for k in range(300):
        action, memory = model.predict(observation[None], memory, start, deterministic=True)
        start = np.zeros(1, dtype=bool)
        observation, _, _, _, info = env.step(action[0])
        assert seen.command[k, 0] == pytest.approx(info["command"], abs=1e-5)
