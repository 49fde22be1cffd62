"""A trained policy of Stable-Baselines3 as an agent, for evaluation beside controllers."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env.setup import Setup
from flexarm_env.tasks import Task


class Predictor(Protocol):
    """Interface of a model of Stable-Baselines3 or sb3-contrib."""

    def predict(self, observation: Any, state: Any, episode_start: Any, deterministic: bool) -> tuple[Any, Any]:
        """Compute actions and the memory of a recurrent policy."""


class TrainedPolicy:
    """Drives arms by a model that was trained on normalised observations.

    Args:
        model: of Stable-Baselines3 or sb3-contrib, recurrent or not.
        task: of its training.
        arm: of its training, with the sensors.
    """

    def __init__(self, model: Predictor, task: Task, arm: Arm) -> None:
        self.model = model
        self.scales = Setup(task, arm).scales().astype(np.float32)
        self.memory: Any = None
        self.starts = np.ones(1, dtype=bool)

    def reset(self, count: int | None = None) -> None:
        """Start an episode of `count` arms, or of one."""
        self.memory, self.starts = None, np.ones(count or 1, dtype=bool)

    def action(self, observation: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
        """Compute shares of the limit (arms, 1) for physical observations (arms, signals + 1)."""
        seen = np.asarray(observation, dtype=np.float32) / self.scales
        action, self.memory = self.model.predict(seen, self.memory, self.starts, True)
        self.starts = np.zeros_like(self.starts)
        return np.asarray(action, dtype=np.float32)
