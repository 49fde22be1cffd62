"""The environment of one arm."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Literal, Unpack

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.envs.registration import EnvSpec
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env.arguments import ArmLike, EnvArguments, find_prior, make_setup
from flexarm_env.env.batch import Batch
from flexarm_env.env.layout import LARGEST_ACTION, REWARD, SAMPLE_COUNT, TERMINATED
from flexarm_env.env.seeds import one_seed
from flexarm_env.env.setup import Setup
from flexarm_env.env.spec import plain_spec
from flexarm_env.env.start import find_start
from flexarm_env.env.state import State
from flexarm_env.env.view import View
from flexarm_env.errors import InputError
from flexarm_env.tasks import CONTROL_RATE, Task

Observation = NDArray[np.float32]

#: Pictures per second that a window shows [Hz].
WINDOW_RATE = 50.0


def spaces_of(setup: Setup) -> tuple[spaces.Box[Any], spaces.Box[Any]]:
    """Make the spaces of observations (signals + 1,) and of actions (1,)."""
    high = setup.bounds().astype(np.float32)
    return spaces.Box(-high, high, dtype=np.float32), spaces.Box(-1.0, 1.0, (1,), np.float32)


class FlexArmEnv(gym.Env[Observation, NDArray[np.float32]]):
    """One flexible arm at a task; the classes of the registered tasks, such as SlewEnv, are pages about each.

    An episode is truncated after the task's duration, or after `duration` seconds, at any control rate. A `max_episode_steps`
    of `gymnasium.make` ends it earlier.

    An environment can be copied and pickled in the middle of an episode: the copy goes on bit for bit. A window stays with the
    original.

    Args:
        task: its name, or a Task.
        arm: name of a shipped arm, path of an arm file, or an Arm: the machine.
        render_mode: "human", "rgb_array" or None.
        arguments: prior, randomise, vary, disturb, control_rate, duration, physical: see EnvArguments.

    Attributes:
        setup: task, arm and settings; its `samples` are the steps of an episode at the control rate.
        prior: the model of the arm for controllers.
        title: of the pictures; task and arm by default.

    Raises:
        UnknownArgument: for an argument that does not exist.
        InputError: for one that does not make sense.

    Examples:
        >>> env = FlexArmEnv("damp", "thesis-fem", physical=True)
        >>> observation, info = env.reset(seed=0)
        >>> observation.shape, info["stuck"]
        ((5,), True)
        >>> observation, reward, terminated, truncated, info = env.step([0.2])
        >>> terminated, info["command"]
        (False, 1.0)
        >>> before = env.state()
        >>> first = env.step([0.5])[0]
        >>> env.set_state(before)
        >>> bool((env.step([0.5])[0] == first).all())
        True
        >>> env.close()
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": int(CONTROL_RATE)}  # noqa: RUF012
    _spec: EnvSpec | None = None

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
        self.metadata = {**self.metadata, "render_fps": self.setup.frame_rate}
        self.samples = self.setup.samples
        #: Steps from picture to picture of a window, which cannot keep up with every step.
        self.every = max(round(self.setup.rate / WINDOW_RATE), 1)
        self.started = False
        self.view: View | None = None
        self.title: str | None = None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
        """Start an episode: with a seed, the first one of that seed; else the next.

        Args:
            seed: of the episode's random draws, from 0 to 2⁶⁴ − 1.
            options: "state": [q, q̇, extra] (states,) at the start, as `state().physical` has it, or a State, from which the
                episode goes on in its middle; "target": angle [rad], whose sign a task may change in turn.

        Raises:
            InputError: for an option that does not exist or does not make sense, a seed that is none, or one beside a State; the
                present episode then goes on.
        """
        batch = self.batch
        start = find_start(options, self.setup, (1, batch.plant.states))
        start.check_seed(seed)
        given = one_seed(seed)
        if start.state is not None:
            self.set_state(start.state)
            batch.aim([0], start)
        else:
            new = int(self.np_random.integers(2**62)) if given is None and not self.started else given
            batch.reset([0], [new], start)
            super().reset(seed=given)
            self.started = True
        if self.render_mode == "human":
            self.render()
        return batch.first_observation.copy(), batch.info_of(batch.first_outcome.tolist())

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Apply the command action · limit for one sample.

        Returns:
            Observation (signals + 1,), reward, terminated, truncated and info.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
            InputError: for an action of another shape, one that is not a number, or one beyond ±1e6; others are clipped.
        """
        batch = self.batch
        if not self.started:
            raise gym.error.ResetNeeded("step before reset: call env.reset() first")
        batch.requested[0] = one_command(action) * batch.limit
        batch.step()
        outcome = batch.first_outcome.tolist()
        if self.render_mode == "human" and outcome[SAMPLE_COUNT] % self.every == 0.0:
            self.render()
        truncated = outcome[SAMPLE_COUNT] >= self.samples
        return batch.first_observation.copy(), outcome[REWARD], outcome[TERMINATED] > 0.0, truncated, batch.info_of(outcome)

    def state(self) -> State:
        """Copy everything on which the next steps depend; `state().physical` is the machine's [q, q̇, extra] (states,).

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
        """
        if not self.started:
            raise gym.error.ResetNeeded("state before reset: call env.reset() first")
        state = self.batch.state()
        return replace(state, physical=state.physical[0])

    def set_state(self, state: State) -> None:
        """Go on from a state that this environment, or one with the same arguments, has returned.

        Raises:
            InputError: for a state of another environment or arm, or a value of another type.
        """
        self.batch.set_state(state)
        self.started = True

    @property
    def spec(self) -> EnvSpec | None:
        """Registration from which `gymnasium.make` makes an equal environment, in values that JSON has."""
        return self._spec

    @spec.setter
    def spec(self, given: EnvSpec | None) -> None:
        self._spec = plain_spec(given, self.samples)

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
            self.view = View(self.setup, self.render_mode, self.setup.rate / self.every, self.title)
        return self.view.draw(self.batch)

    def close(self) -> None:
        """Close the window, if there is one."""
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
        value = float(value * 1.0)  # a text has a float, too, but no product
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"action {action!r}; give one number from -1 to 1, in shape (1,)") from None
    if -1.0 <= value <= 1.0:
        return value
    if not abs(value) <= LARGEST_ACTION:
        raise InputError(f"action = {value}; give a number from -1 to 1")
    return math.copysign(1.0, value)
