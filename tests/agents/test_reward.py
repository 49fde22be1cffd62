"""The reward of training."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from small_plans import small

from agents.learning.episodes import RATE, EpisodeVecEnv
from flexarm_env import Arm
from flexarm_env.wrappers import RewardOptions, ShapedReward


def test_vibration_weighs_more_as_training_goes_on() -> None:
    env = EpisodeVecEnv(small(actions=80, reward={"vibration": 0.5, "rise": 3.0}), Arm.load("thesis"), 0)
    weights = []
    for _ in range(3):
        env.reset()
        weights.append(env.groups[0].shaping.reward.vibration)
    assert weights == [0.5, 0.75, 1.0]  # 20 actions in each batch of episodes


def vibration_costs(frequency: float, amplitude: float) -> np.ndarray:
    """Rewards of 400 samples in which nothing is wrong but the base strain."""
    arm = Arm.load("thesis")
    nothing = {name: np.zeros(1) for name in ("hub_angle", "tip_deflection", "target")}
    batch = SimpleNamespace(noiseless_readings=np.zeros((1, 4)), info=lambda: nothing, count=1)
    setup, gage = SimpleNamespace(arm=arm, rate=RATE), list(arm.signals).index("strain_base")
    reward = ShapedReward(RewardOptions(), setup, batch)  # type: ignore[arg-type]
    reward.start(0.0)
    costs = []
    for k in range(1, 401):
        batch.noiseless_readings[0, gage] = amplitude * np.sin(2.0 * np.pi * frequency * k / RATE)
        costs.append(-reward.sample()[0])
    return np.array(costs[100:])


def test_the_cost_of_vibration_is_that_of_its_amplitude() -> None:
    costs, scale, weight = vibration_costs(2.0, 0.03), 0.01, 0.5
    np.testing.assert_allclose(costs, weight * np.log1p(0.03 / scale) / np.log1p(3.0 / scale), rtol=1e-9)
    # a vibration ten times as fast costs no more, though its rate is ten times as large
    assert vibration_costs(24.0, 0.03).mean() < costs.mean()
