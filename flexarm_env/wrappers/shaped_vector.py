"""Many arms as policies are trained on them: the same bits for each as for one alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorWrapper
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from flexarm_env.env.arguments import check_count
from flexarm_env.env.batch import Batch
from flexarm_env.errors import InputError
from flexarm_env.vector_env import FlexArmVectorEnv
from flexarm_env.wrappers.options import InterfaceOptions, RewardOptions
from flexarm_env.wrappers.shaping import Shaping, refuse_other, refuse_state

Array = NDArray[Any]


class ShapedVector(VectorWrapper):  # its type parameters came with gymnasium 1.4
    """Many arms with the observation, the action and the reward of the shipped policies; see Shaped.

    Episodes start and end together, since filters and controllers are reset for all arms at once. Where one arm leaves the
    range of its task, the episodes of the others are truncated.

    Args:
        env: of many arms, made with physical=True.
        interface: observation and action: InterfaceOptions, or a table of them.
        reward: RewardOptions, or a table of them; None for the reward of the task, summed over the samples of an action.
        max_episode_steps: actions after which episodes are truncated; those of the task's duration by default.

    Raises:
        InputError: for an environment of another kind, observations that are not physical, options that do not exist, an arm that
            lacks what they need, or a number of actions that is no whole number from 1 up.

    Examples:
        >>> env = ShapedVector(FlexArmVectorEnv(3, "slew", physical=True), {"base": "pd", "repeat": 4})
        >>> observations, infos = env.reset(seed=0)
        >>> observations, rewards, terminated, truncated, infos = env.step(np.zeros((3, 1)))
        >>> observations.shape, rewards.shape
        ((3, 36), (3,))
        >>> env.close()
    """

    def __init__(
        self,
        env: FlexArmVectorEnv,
        interface: InterfaceOptions | Mapping[str, Any] = InterfaceOptions(),  # noqa: B008 - frozen
        reward: RewardOptions | Mapping[str, Any] | None = RewardOptions(),  # noqa: B008 - frozen
        max_episode_steps: int | None = None,
    ) -> None:
        if max_episode_steps is not None:
            check_count("max_episode_steps", max_episode_steps)
        super().__init__(env)
        self.arms = refuse_other(env, FlexArmVectorEnv)
        self.shaping = Shaping(env.setup, env.batch, env.prior, interface, reward)
        if max_episode_steps is not None:
            self.shaping.steps = min(self.shaping.steps, max_episode_steps)
        self.single_observation_space = self.shaping.observation_space
        self.single_action_space = self.shaping.action_space
        self.observation_space = batch_space(self.single_observation_space, env.num_envs)
        self.action_space = batch_space(self.single_action_space, env.num_envs)
        self.over = np.zeros(env.num_envs, dtype=bool)
        #: Features after the last step, before any new episode (arms, features).
        self.observations: Array = np.zeros((env.num_envs, self.shaping.interface.size), dtype=np.float32)

    @property
    def batch(self) -> Batch:
        """Arms of the environment."""
        return self.arms.batch

    @property
    def lengths(self) -> Array:
        """Actions since the start of each arm's episode (arms,)."""
        return np.full(self.num_envs, self.shaping.step_number)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Start an episode of every arm, as FlexArmVectorEnv.reset does.

        Raises:
            InputError: for a whole state, or a mask of some arms only, beside what FlexArmVectorEnv refuses.
        """
        refuse_state(options)
        if not np.all((options or {}).get("reset_mask", True)):
            raise InputError("reset_mask of some arms only: episodes of these arms start together; leave out the mask")
        observations, infos = self.arms.reset(seed=seed, options=options)
        self._start(observations)
        return self.observations.copy(), infos

    def begin(self, seed: int, share: float) -> Array:
        """Start an episode of every arm at a share of a training, see ShapedReward; return features (arms, features)."""
        observations, _ = self.arms.reset(seed=seed)
        self._start(observations, share)
        return self.observations

    def _start(self, observations: Array, share: float = 1.0) -> None:
        self.observations = self.shaping.start(observations, share)
        self.over = np.zeros(self.num_envs, dtype=bool)

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Hold actions (arms, numbers) for their samples.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset, or at the end of an episode without autoreset.
            InputError: for actions of another shape, that are not numbers, or beyond ±1e6.
        """
        arms, mode = self.arms, self.arms.autoreset_mode
        if self.over.any():
            if mode is AutoresetMode.DISABLED:
                raise gym.error.ResetNeeded("episodes are over: call envs.reset() first")
            self.restart()
            nothing = np.zeros(self.num_envs, dtype=bool)
            return self.observations.copy(), np.zeros(self.num_envs), nothing, nothing.copy(), arms.infos()
        rewards, terminated, truncated = self.move(actions)
        if mode is AutoresetMode.SAME_STEP and self.over.any():
            last = np.empty(self.num_envs, dtype=object)
            for i, one in enumerate(self.observations):
                last[i] = one.copy()
            final = {"final_obs": last, "_final_obs": self.over, "final_info": arms.infos(), "_final_info": self.over.copy()}
            self.restart()
            return self.observations.copy(), rewards, terminated, truncated, arms.infos() | final
        return self.observations.copy(), rewards, terminated, truncated, arms.infos()

    def move(self, actions: Array) -> tuple[Array, Array, Array]:
        """Hold actions (arms, numbers) and start nothing anew; return rewards, terminated and truncated (arms,).

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
            InputError: for actions of another shape, that are not numbers, or beyond ±1e6.
        """
        arms = self.arms

        def sample(commands: Array) -> tuple[Array, Array, Array]:
            rewards, terminated, _ = arms.move(commands)
            return arms.batch.observations, rewards, terminated

        self.observations, rewards, terminated = self.shaping.step(actions, sample)
        self.over = np.full(self.num_envs, self.shaping.over or bool(terminated.any()))
        return rewards, terminated, self.over & (~terminated | self.shaping.over)

    def restart(self) -> None:
        """Start the next episode of every arm."""
        observations, _ = self.arms.reset()
        self._start(observations)
