"""One arm as policies are trained on it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from flexarm_env.env.flexarm import FlexArmEnv
from flexarm_env.wrappers.options import InterfaceOptions, RewardOptions
from flexarm_env.wrappers.shaping import Shaping, refuse_other, refuse_state

Floats = NDArray[np.float32]


class Shaped(gym.Wrapper[Floats, Floats, Floats, Floats], RecordConstructorArgs):
    """An environment with the observation, the action and the reward of the shipped policies.

    A step holds its action for some samples. Its observation is made of past readings and commands, and of estimates; its
    command may be added to that of a base controller. `info` is that of the last sample.

    Args:
        env: of one arm, made with physical=True.
        interface: observation and action: InterfaceOptions, or a table of them.
        reward: RewardOptions, or a table of them; None for the reward of the task, summed over the samples of an action.

    Raises:
        InputError: for an environment of another kind, observations that are not physical, options that do not exist, or an arm
            that lacks what they need.

    Examples:
        >>> import flexarm_env
        >>> bare = gym.make("FlexArm/Slew-v0", physical=True)
        >>> env = Shaped(bare, {"lags": [0, 4], "command_lags": [0], "estimate": False, "repeat": 4}, reward=None)
        >>> observation, info = env.reset(seed=0)
        >>> observation.shape, env.action_space.shape  # four readings now and 20 ms ago, and the last command
        ((9,), (1,))
        >>> env.close()
    """

    def __init__(
        self,
        env: gym.Env[Floats, Floats],
        interface: InterfaceOptions | Mapping[str, Any] = InterfaceOptions(),  # noqa: B008 - frozen
        reward: RewardOptions | Mapping[str, Any] | None = RewardOptions(),  # noqa: B008 - frozen
    ) -> None:
        bare = refuse_other(env.unwrapped, FlexArmEnv)
        RecordConstructorArgs.__init__(self, interface=table_of(interface), reward=table_of(reward))
        gym.Wrapper.__init__(self, env)
        self.shaping = Shaping(bare.setup, bare.batch, bare.prior, interface, reward)
        self.observation_space, self.action_space = self.shaping.observation_space, self.shaping.action_space

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Start an episode, as FlexArmEnv.reset does.

        Raises:
            InputError: for a whole state among the options, beside those that FlexArmEnv refuses.
        """
        refuse_state(options)
        observation, info = self.env.reset(seed=seed, options=options)
        return self.shaping.start(observation[None])[0], info

    def step(self, action: Floats) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """Hold an action (numbers,) for its samples.

        Returns:
            Observation (features,), reward, terminated, truncated, and the info of the last sample.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
            InputError: for an action of another shape, that is not a number, or beyond ±1e6.
        """
        truncated = False
        info: dict[str, Any] = {}

        def move(command: Floats) -> tuple[Floats, Floats, NDArray[np.bool_]]:
            nonlocal truncated, info
            observation, reward, terminated, ended, info = self.env.step(command[0])
            truncated |= ended
            return observation[None], np.array([reward]), np.array([terminated])

        features, rewards, terminated = self.shaping.step(action[None] if isinstance(action, np.ndarray) else [action], move)
        return features[0], float(rewards[0]), bool(terminated[0]), truncated or self.shaping.over, info


def table_of(options: Any) -> dict[str, Any] | None:
    """Convert options to a table of values that JSON has."""
    if options is None:
        return None
    given = options if isinstance(options, Mapping) else vars(options)
    return {name: list(value) if isinstance(value, tuple) else value for name, value in given.items()}
