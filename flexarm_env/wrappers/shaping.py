"""What the wrappers of one arm and of many have in common: features, held actions and reward over the samples of an action."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env.batch import Batch
from flexarm_env.env.given import real_array
from flexarm_env.env.layout import LARGEST_ACTION
from flexarm_env.env.setup import Setup
from flexarm_env.env.state import State
from flexarm_env.errors import InputError
from flexarm_env.wrappers.interface import LARGEST_FEATURE, PolicyInterface
from flexarm_env.wrappers.options import InterfaceOptions, RewardOptions, read_options
from flexarm_env.wrappers.reward import ShapedReward

Array = NDArray[Any]
Options = TypeVar("Options")
Env = TypeVar("Env")

#: Moves arms by one sample under commands (arms, 1): returns observations (arms, signals + 1), rewards and terminated (arms,).
Move = Callable[[Array], tuple[Array, Array, Array]]


class Shaping:
    """Between a policy and many arms whose episodes start and end together.

    Args:
        setup: of the arms' environment.
        batch: of the arms.
        prior: modelled by the filters and the base controller.
        interface: features, and effect of the actions; options or a table of them.
        reward: the same of the reward; None for that of the task, summed over the samples of an action.

    Attributes:
        steps: actions of an episode.
        step_number: actions since its start.
        started: whether an episode has been started.

    Raises:
        InputError: for observations that are not physical, options that do not exist, or an arm that lacks what they need.
    """

    def __init__(
        self,
        setup: Setup,
        batch: Batch,
        prior: Arm,
        interface: InterfaceOptions | Mapping[str, Any],
        reward: RewardOptions | Mapping[str, Any] | None,
    ) -> None:
        if not setup.physical:
            raise InputError("the wrapper needs readings in SI units: make the environment with physical=True")
        if list(prior.signals) != list(setup.arm.signals):
            raise InputError(f"prior '{prior.name}' has other sensors than the arm; give one with the sensors of the arm")
        options = read(InterfaceOptions, interface)
        self.interface = PolicyInterface(options, prior, 1.0 / setup.rate)
        self.reward = None if reward is None else ShapedReward(read(RewardOptions, reward), setup, batch)
        self.count, self.repeat = batch.count, options.repeat
        self.steps, self.step_number, self.started = max(setup.samples // options.repeat, 1), 0, False
        self.observation_space = spaces.Box(-LARGEST_FEATURE, LARGEST_FEATURE, (self.interface.size,), np.float32)
        self.action_space = spaces.Box(-1.0, 1.0, (options.actions,), np.float32)

    def start(self, observations: Array, share: float = 1.0) -> NDArray[np.float32]:
        """Begin episodes from observations (arms, signals + 1), at a share of a training; return features (arms, features)."""
        self.started, self.step_number = True, 0
        self.interface.start(self.count)
        self.interface.see(observations)
        if self.reward:
            self.reward.start(share)
        return self.interface.features()

    def step(self, actions: Array | Sequence[Array], move: Move) -> tuple[NDArray[np.float32], Array, Array]:
        """Hold actions (arms, numbers) for their samples, or until an episode ends early.

        Returns:
            Features (arms, features), rewards (arms,) and terminated (arms,).

        Raises:
            gymnasium.error.ResetNeeded: before the first start.
            InputError: for actions of another shape, that are not numbers, or beyond ±1e6.
        """
        if not self.started:
            raise gym.error.ResetNeeded("step before reset: call reset first")
        shape = (self.count, *self.action_space.shape)
        given = real_array(actions)
        if given is None or given.shape != shape or not (np.abs(given) <= LARGEST_ACTION).all():
            raise InputError(f"actions {actions!r}; give finite numbers from -1 to 1 in shape {shape}")
        rewards = np.zeros(self.count)
        for _ in range(self.repeat):
            observations, own, terminated = move(self.interface.send(given))
            self.interface.see(observations)
            rewards += own if self.reward is None else self.reward.sample() / self.repeat
            if terminated.any():
                break
        if self.reward:
            rewards += self.reward.command(self.interface.command)
        self.step_number += 1
        return self.interface.features(), rewards, terminated

    @property
    def over(self) -> bool:
        """Whether all actions of the episode have been taken."""
        return self.step_number >= self.steps


def read(section: type[Options], given: Options | Mapping[str, Any]) -> Options:
    """Pass options on, or read a table of them."""
    return given if isinstance(given, section) else read_options(section, given)


def refuse_state(options: Mapping[str, Any] | None) -> None:
    """Refuse to begin in the middle of an episode, of which the wrapper has no memory.

    Raises:
        InputError: saying so.
    """
    if isinstance(options, Mapping) and isinstance(options.get("state"), State):
        raise InputError(
            "options: a whole state lacks the wrapper's memory; give state.physical, or go on from copy.deepcopy(env)"
        )


def refuse_other(env: Any, kind: type[Env]) -> Env:
    """Refuse an environment that has no arms, or is not of the wrapper's kind; return the others.

    Raises:
        InputError: with the environment that is wrapped.
    """
    if not isinstance(env, kind):
        raise InputError(f"the wrapper works on {kind.__name__}, not on {type(env).__name__}; wrap an environment of FlexArm")
    return env
