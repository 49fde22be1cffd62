"""The environment of one arm."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env.batch import Batch
from flexarm_env.env.kernel import COMMAND, REWARD, TARGET, TERM, TERMINATED
from flexarm_env.env.setup import Setup
from flexarm_env.env.variation import Disturbance, Range, find_disturbance, find_variation
from flexarm_env.env.view import View
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.tasks import Task, find_task

Observation = NDArray[np.float32]

#: Arguments of an environment, beside the task.
ARGUMENTS = ("arm", "prior", "randomise", "vary", "disturb", "control_rate", "physical", "render_mode", "task")


def make_setup(
    task: str | Task,
    arm: str | Path | Arm,
    randomise: Mapping[str, Range] | None,
    vary: Mapping[str, float] | None,
    disturb: Disturbance | Mapping[str, float] | None,
    control_rate: float,
    physical: bool,
) -> Setup:
    """Return what an environment is made of, from its arguments.

    Raises:
        InputError: for an argument that does not make sense, in one line.
    """
    if isinstance(control_rate, bool) or not isinstance(control_rate, int | float | np.number):
        raise InputError(f"control_rate = {control_rate!r}; give a number [Hz]")
    if not isinstance(physical, bool | np.bool_):
        raise InputError(f"physical = {physical!r}; give True or False")
    drawn, variation = find_variation(find_arm(arm), randomise, vary)
    return Setup(find_task(task), drawn, variation, find_disturbance(disturb), float(control_rate), bool(physical))


def find_arm(arm: str | Path | Arm) -> Arm:
    """Return an arm from its name, its file or itself.

    Raises:
        InputError: for anything else.
    """
    if isinstance(arm, Arm):
        return arm
    if not isinstance(arm, str | Path):
        raise InputError(f"arm = {arm!r}; give a name, the path of an arm file, or an Arm")
    return Arm.load(arm)


def refuse_unknown(unknown: Mapping[str, Any], known: Sequence[str] = ARGUMENTS) -> None:
    """Refuse arguments that an environment does not have.

    Raises:
        InputError: naming the first of them, and the nearest that exists.
    """
    for name in unknown:
        raise InputError(f"unknown argument '{name}'{did_you_mean(name, known)}")


def spaces_of(setup: Setup) -> tuple[spaces.Box[Any], spaces.Box[Any]]:
    """Return the spaces of observations (signals + 1,) and of actions (1,)."""
    high = setup.bounds().astype(np.float32)
    return spaces.Box(-high, high, dtype=np.float32), spaces.Box(-1.0, 1.0, (1,), np.float32)


class FlexArmEnv(gym.Env[Observation, NDArray[np.float32]]):
    """One flexible arm at a task; SlewEnv, TrackEnv and DampEnv are pages about the three tasks.

    Args:
        task: its name, or a Task.
        arm: name of a shipped arm, path of an arm file, or an Arm: the machine.
        prior: the arm that a controller believes in; the machine's nominal values by default.
        randomise: values drawn anew for each episode: {"payload.mass": (0.0, 0.3)}, lowest and highest in SI units.
        vary: the same as shares of the arm's own values: {"hub.inertia": 0.1} is ±10 %.
        disturb: taps and drop-outs, see Disturbance: {"tap_rate": 0.5, "tap_torque": 0.3, "dropout_rate": 1.0}.
        control_rate: steps per second [Hz].
        physical: observations in SI units, not normalised.
        render_mode: "human", "rgb_array" or None.

    Attributes:
        title: of the pictures; task and arm by default.

    Raises:
        InputError: for an argument that does not exist or does not make sense.
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 50}  # noqa: RUF012

    def __init__(
        self,
        task: str | Task = "slew",
        arm: str | Path | Arm = "thesis",
        *,
        prior: str | Path | Arm | None = None,
        randomise: Mapping[str, Range] | None = None,
        vary: Mapping[str, float] | None = None,
        disturb: Disturbance | Mapping[str, float] | None = None,
        control_rate: float = 200.0,
        physical: bool = False,
        render_mode: Literal["human", "rgb_array"] | None = None,
        **unknown: Any,
    ) -> None:
        refuse_unknown(unknown)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise InputError(f"render_mode = {render_mode!r}; allowed are 'human', 'rgb_array' and None")
        self.setup = make_setup(task, arm, randomise, vary, disturb, control_rate, physical)
        self.prior = find_arm(arm if prior is None else prior)
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
        return self.batch.first_observation.copy(), _info(self.batch.told_of_first.tolist())

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Apply the command action · limit for one sample.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
            InputError: for an action of another shape, or one that is not a number.
        """
        batch = self.batch
        if not self.started:
            raise gym.error.ResetNeeded("step before reset: call env.reset() first")
        batch.asked[0] = one_command(action) * batch.limit
        batch.step()
        if self.render_mode == "human":
            self.render()
        told = batch.told_of_first.tolist()
        return batch.first_observation.copy(), told[REWARD], told[TERMINATED] > 0.0, False, _info(told)

    def state(self) -> NDArray[np.float64]:
        """Return the machine's state [q, q̇, extra], see Plant.physical: what no controller sees."""
        plant = self.batch.plant
        plant.state[:] = self.batch.states[0]
        plant.constants[:] = self.batch.constants[0]
        return plant.physical()

    def drawn_arm(self) -> Arm:
        """Return the machine as it was drawn for this episode."""
        return self.batch.arm_of(0)

    def render(self) -> NDArray[np.uint8] | None:
        """Draw the arm as it stands.

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
    """Return an action (1,) as a share of the limit.

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


def _info(told: list[float]) -> dict[str, Any]:
    """Return an info from what is told of an arm; written out, since it is made in every step."""
    return {
        "hub_angle": told[0],
        "hub_speed": told[1],
        "tip_deflection": told[2],
        "stuck": told[3] > 0.0,
        "target": told[TARGET],
        "command": told[COMMAND],
        "reward_distance": told[TERM],
        "reward_closeness": told[TERM + 1],
        "reward_vibration": told[TERM + 2],
        "reward_effort": told[TERM + 3],
        "reward_rate": told[TERM + 4],
        "reward_failure": told[TERM + 5],
    }
