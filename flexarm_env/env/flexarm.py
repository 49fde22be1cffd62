"""The environment of one arm."""

from __future__ import annotations

import math
from typing import Any, Literal, Unpack

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env.arguments import ArmLike, EnvArguments, find_prior, make_setup
from flexarm_env.env.batch import Batch
from flexarm_env.env.layout import REWARD, TERMINATED
from flexarm_env.env.setup import Setup
from flexarm_env.env.view import View
from flexarm_env.errors import InputError
from flexarm_env.tasks import Task

Observation = NDArray[np.float32]


def spaces_of(setup: Setup) -> tuple[spaces.Box[Any], spaces.Box[Any]]:
    """Make the spaces of observations (signals + 1,) and of actions (1,)."""
    high = setup.bounds().astype(np.float32)
    return spaces.Box(-high, high, dtype=np.float32), spaces.Box(-1.0, 1.0, (1,), np.float32)


class FlexArmEnv(gym.Env[Observation, NDArray[np.float32]]):
    """One flexible arm at a task; the classes of the registered tasks, such as SlewEnv, are pages about each.

    An environment built from the class never truncates an episode: wrap it in `gymnasium.wrappers.TimeLimit`, with
    `setup.samples` steps. `gymnasium.make` adds a limit itself, `max_episode_steps`: the task's steps at 200 Hz at any
    control rate, unless it is given.

    Args:
        task: its name, or a Task.
        arm: name of a shipped arm, path of an arm file, or an Arm: the machine.
        render_mode: "human", "rgb_array" or None.
        arguments: prior, randomise, vary, disturb, control_rate, physical: see EnvArguments.

    Attributes:
        setup: task, arm and settings; its `samples` are the steps of an episode at the control rate.
        prior: the model of the arm for controllers.
        title: of the pictures; task and arm by default.

    Raises:
        InputError: for an argument that does not exist or does not make sense.

    Examples:
        >>> env = FlexArmEnv("damp", "thesis-fem", physical=True)
        >>> observation, info = env.reset(seed=0)
        >>> observation.shape, info["stuck"]
        ((5,), True)
        >>> observation, reward, terminated, truncated, info = env.step([0.2])
        >>> terminated, info["command"]
        (False, 1.0)
        >>> env.close()
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 50}  # noqa: RUF012

    def __init__(
        self,
        task: str | Task = "slew",
        arm: ArmLike = "thesis",
        *,
        render_mode: Literal["human", "rgb_array"] | None = None,
        **arguments: Unpack[EnvArguments],
    ) -> None:
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise InputError(f"render_mode = {render_mode!r}; allowed are 'human', 'rgb_array' and None")
        self.setup = make_setup(task, arm, arguments)
        self.prior = find_prior(arm, arguments)
        self.batch = Batch(self.setup, 1)
        self.observation_space, self.action_space = spaces_of(self.setup)
        self.render_mode: Literal["human", "rgb_array"] | None = render_mode
        self.started = False
        self.view: View | None = None
        self.title: str | None = None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
        """Start an episode: with a seed, the first one of that seed; else the next. Options are not used."""
        super().reset(seed=seed)
        if seed is None and not self.started:
            seed = int(self.np_random.integers(2**62))
        self.batch.reset([0], [seed])
        self.started = True
        if self.view:
            self.view.clear()
        if self.render_mode == "human":
            self.render()
        return self.batch.first_observation.copy(), self.batch.info_of(self.batch.first_outcome.tolist())

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Apply the command action · limit for one sample.

        Returns:
            Observation (signals + 1,), reward, terminated, truncated, which is always False here, and info.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
            InputError: for an action of another shape, or one that is not a number.
        """
        batch = self.batch
        if not self.started:
            raise gym.error.ResetNeeded("step before reset: call env.reset() first")
        batch.requested[0] = one_command(action) * batch.limit
        batch.step()
        if self.render_mode == "human":
            self.render()
        outcome = batch.first_outcome.tolist()
        return batch.first_observation.copy(), outcome[REWARD], outcome[TERMINATED] > 0.0, False, batch.info_of(outcome)

    def state(self) -> NDArray[np.float64]:
        """Compute the machine's state [q, q̇, extra], see Plant.physical; it is hidden from controllers."""
        plant = self.batch.plant
        plant.state[:] = self.batch.states[0]
        plant.constants[:] = self.batch.constants[0]
        return plant.physical()

    def drawn_arm(self) -> Arm:
        """Look up the machine that was drawn for this episode."""
        return self.batch.arm_of(0)

    def render(self) -> NDArray[np.uint8] | None:
        """Draw the arm in its present shape.

        Returns:
            (height, width, 3) for "rgb_array", nothing for "human".
        """
        if self.render_mode is None:
            gym.logger.warn('render() draws nothing without a mode: gym.make(..., render_mode="rgb_array")')
            return None
        if self.view is None:
            self.view = View(self.setup, self.render_mode, self.metadata["render_fps"], self.title)
        return self.view.draw(self.batch, self.state())

    def close(self) -> None:
        """Close the window."""
        if self.view:
            self.view.close()
            self.view = None


def one_command(action: Any) -> float:
    """Convert an action (1,) to a share of the limit, clipped to -1 to 1.

    kernel.request clips the actions of many arms; to call it for one number takes longer than these comparisons.

    Raises:
        InputError: for another shape or a value that is not a number.
    """
    try:
        (value,) = action.tolist() if isinstance(action, np.ndarray) else action
        value = float(value)
    except (TypeError, ValueError):
        raise InputError(f"action {action!r}; give one number from -1 to 1, in shape (1,)") from None
    if -1.0 <= value <= 1.0:
        return value
    if not math.isfinite(value):
        raise InputError(f"action = {value}; give a number from -1 to 1")
    return math.copysign(1.0, value)
