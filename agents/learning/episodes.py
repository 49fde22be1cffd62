"""Arms at a task as a VecEnv of Stable-Baselines3: features in, actions out, with all episodes in step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from agents.learning.interface import PolicyInterface, squeezed
from agents.learning.options import ArmsOptions, Plan
from agents.learning.reward import TrainingReward
from flexarm_env.arm import Arm
from flexarm_env.tasks import TASKS, Task
from flexarm_env.trials.sets import FIRST_SEED, ArmSet
from flexarm_env.vector_env import FlexArmVectorEnv

Array = NDArray[Any]

RATE = 200.0
#: Seeds of each run: those of training stay below those of evaluation, and no two runs share any.
SEEDS_EACH = 10_000_000
#: As FINE in interface.py, for the critic's privileged inputs: angle's error [rad], speed [rad/s], tip [m], its change [m].
FINE_TRUTH = (0.003, 0.03, 0.001, 0.0001)


class EpisodeVecEnv(VecEnv):
    """Many arms with episodes of equal length, so that filters and controllers are reset for all at once.

    Arms do not leave their range here, where evaluation would end their episode. Arm i of episode k of a run with seed s
    is drawn from the seed s · 10⁷ + k · arms + i.

    Args:
        plan: task, arms, interface, reward.
        arm: simulated, and modelled by the interface.
        seed: of the run.
    """

    render_mode = None

    def __init__(self, plan: Plan, arm: Arm, seed: int) -> None:
        roomy = replace(TASKS[plan.task], range=math.inf)
        arms = training_set(plan.arms)
        self.envs = FlexArmVectorEnv(plan.at_once, roomy, arm, control_rate=RATE, physical=True, **arms.arguments(arm))
        self.interface = PolicyInterface(plan.interface, arm, 1.0 / RATE)
        self.reward = TrainingReward(plan.reward, self.envs)
        self.repeat, self.steps = plan.interface.repeat, actions_each(TASKS[plan.task], plan.interface.repeat)
        self.actions_in_all = plan.actions
        self.privileged = plan.interface.privileged and plan.algorithm == "ppo"
        self.first_seed, self.next_episode = seed * SEEDS_EACH, 0
        #: Mean over all arms of the last episodes' returns; None before the first end.
        self.mean_return: float | None = None
        ranges = len(self.envs.setup.variation.ranges)
        self.width = self.interface.size + (len(FINE_TRUTH) + ranges if self.privileged else 0)
        super().__init__(plan.at_once, *spaces_of(self.width, plan.interface.actions))

    def reset(self) -> Array:
        """Start the next episode of all arms; return the inputs of policy and critic (arms, width)."""
        count, batch = self.num_envs, self.envs.batch
        first = self.first_seed + self.next_episode * count % SEEDS_EACH
        share = min(self.next_episode * count * self.steps / self.actions_in_all, 1.0)
        self.next_episode += 1
        observation, _ = self.envs.reset(seed=first % FIRST_SEED)
        self.interface.start(count)
        self.interface.see(observation)
        self.reward.start(share)
        self.draws = np.array([batch.draws_of(i) for i in range(count)]).reshape(count, -1)
        self.returns, self.step_number = np.zeros(count), 0
        self.tip = batch.info()["tip_deflection"]
        return self._observe()

    def step_async(self, actions: Array) -> None:
        """Set the actions (arms, 1 or 2) of the next step."""
        self.actions = actions

    def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
        """Hold the actions for `repeat` samples; return observations, rewards, ends of episodes, and infos."""
        rewards = np.zeros(self.num_envs)
        for _ in range(self.repeat):
            self.envs.move(self.interface.send(self.actions))
            self.interface.see(self.envs.batch.observations)
            rewards += self.reward.sample() / self.repeat
        rewards += self.reward.command(self.interface.command)
        self.returns += rewards
        self.step_number += 1
        observation, over = self._observe(), self.step_number >= self.steps
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        if over:
            self.mean_return = float(self.returns.mean())
            for i, info in enumerate(infos):
                info["terminal_observation"], info["TimeLimit.truncated"] = observation[i], True
                info["episode"] = {"r": float(self.returns[i]), "l": self.steps, "t": 0.0}
            observation = self.reset()
        return observation, rewards.astype(np.float32), np.full(self.num_envs, over), infos

    def _observe(self) -> Array:
        seen = self.interface.features()
        if not self.privileged:
            return seen
        info, before = self.envs.batch.info(), self.tip
        self.tip = info["tip_deflection"]
        truth = (info["target"] - info["hub_angle"], info["hub_speed"], self.tip, self.tip - before)
        hidden = [squeezed(values, fine)[:, None] for values, fine in zip(truth, FINE_TRUTH, strict=True)]
        return np.concatenate([seen, *hidden, self.draws], axis=1, dtype=np.float32)

    def close(self) -> None:
        """Close the arms' environment."""
        self.envs.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Return an attribute, once for each arm."""
        return [getattr(self, attr_name) for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute for all arms."""
        setattr(self, attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> list[Any]:
        """Call a method once for each arm."""
        return [getattr(self, method_name)(*args, **kwargs) for _ in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: type, indices: Any = None) -> list[bool]:
        """Return False for each arm: there are no wrappers."""
        return [False for _ in self._get_indices(indices)]

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """Return None for each arm: single environments draw pictures."""
        return [None] * self.num_envs


def spaces_of(width: int, actions: int) -> tuple[spaces.Box[Any], spaces.Box[Any]]:
    """Make the spaces of the inputs of policy and critic (width,) and of actions (actions,)."""
    return spaces.Box(-np.inf, np.inf, (width,), np.float32), spaces.Box(-1.0, 1.0, (actions,), np.float32)


def actions_each(task: Task, repeat: int) -> int:
    """Count the actions of an episode."""
    return max(round(task.duration * RATE) // repeat, 1)


def training_set(options: ArmsOptions) -> ArmSet:
    """Make the set of arms for training; those of flexarm_env/trials/sets.py are for evaluation."""
    disturb = {"tap_rate": options.tap_rate, "dropout_rate": options.dropout_rate}
    return ArmSet("training", "arms to train on", options.payload, options.constants, options.friction, disturb)
