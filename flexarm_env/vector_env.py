"""Many arms in one environment, on the kernel of the single one: the same bits for each arm."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, Unpack

import gymnasium as gym
import numpy as np
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env.arguments import ArmLike, EnvArguments, check_count, find_prior, make_setup
from flexarm_env.env.batch import Batch
from flexarm_env.env.flexarm import spaces_of
from flexarm_env.env.given import is_list, real_array
from flexarm_env.env.layout import REWARD, SAMPLE_COUNT, TERMINATED
from flexarm_env.env.seeds import seeds_of
from flexarm_env.env.spec import plain_spec
from flexarm_env.env.start import Start, find_start
from flexarm_env.env.state import State
from flexarm_env.env.task_envs import refuse_task
from flexarm_env.env.view import View
from flexarm_env.errors import InputError
from flexarm_env.tasks import CONTROL_RATE, TASKS, Task

Array = NDArray[Any]

FURTHER_ARGUMENTS = ("num_envs", "max_episode_steps", "autoreset_mode", "threads")
#: Tasks by the names of their vector environments, such as "SlewVectorEnv".
TASK_OF_CLASS = {f"{task.title}VectorEnv": task for task in TASKS.values()}


class FlexArmVectorEnv(VectorEnv[Array, Array, Array]):
    """Arms at one task; arm i after reset(seed=s) is the single environment after reset(seed=s + i), bit for bit.

    As a single environment, it can be copied, pickled, and set to a state that it had.

    Args:
        num_envs: arms.
        task: its name, or a Task.
        arm: name of a shipped arm, path of an arm file, or an Arm.
        max_episode_steps: after which an episode is truncated; those of its duration by default.
        autoreset_mode: next step, same step or disabled, see gymnasium.vector.AutoresetMode.
        threads: over which the arms are spread; more than one pays from some hundred arms on.
        render_mode: "rgb_array" or None.
        arguments: prior, randomise, vary, disturb, control_rate, duration, physical: see EnvArguments; drawn for each arm and
            episode.

    Raises:
        UnknownArgument: for an argument that does not exist.
        InputError: for one that does not make sense.

    Examples:
        >>> envs = FlexArmVectorEnv(64, "track", randomise={"payload.mass": (0.0, 0.3)})
        >>> observations, infos = envs.reset(seed=0)
        >>> observations, rewards, terminated, truncated, infos = envs.step(np.zeros((64, 1), dtype=np.float32))
        >>> observations.shape, rewards.shape, infos["reward_distance"].shape
        ((64, 5), (64,), (64,))
        >>> envs.close()
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": int(CONTROL_RATE)}  # noqa: RUF012
    _spec: EnvSpec | None = None

    def __init__(
        self,
        num_envs: int = 1,
        task: str | Task = "slew",
        arm: ArmLike = "thesis",
        *,
        max_episode_steps: int | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        threads: int = 1,
        render_mode: str | None = None,
        **arguments: Unpack[EnvArguments],
    ) -> None:
        for name, value in (("num_envs", num_envs), ("threads", threads), ("max_episode_steps", max_episode_steps)):
            if value is not None or name != "max_episode_steps":
                check_count(name, value)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise InputError(f"render_mode = {render_mode!r}; a vector environment has 'rgb_array' and None")
        self.setup = make_setup(task, arm, arguments, FURTHER_ARGUMENTS)
        self.prior = find_prior(arm, arguments)
        self.autoreset_mode = _mode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode, "render_fps": self.setup.frame_rate}
        self.num_envs, self.render_mode = int(num_envs), render_mode
        self.view: View | None = None
        self.max_episode_steps = max_episode_steps or self.setup.samples
        self.batch = Batch(self.setup, self.num_envs, int(threads))
        #: Names under which an info marks the arms that it is about, see gymnasium.vector.VectorEnv.
        self.present = tuple(f"_{name}" for name in self.batch.info_rows)
        self.single_observation_space, self.single_action_space = spaces_of(self.setup)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.every = np.arange(self.num_envs)
        self.all = np.ones(self.num_envs, dtype=bool)
        self.over = np.zeros(self.num_envs, dtype=bool)
        self.started = False

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Start an episode of every arm, or of those in options["reset_mask"] (arms,).

        Args:
            seed: arm i gets seed + i; or one for each, from 0 to 2⁶⁴ − 1; or none, to go on, at first at random.
            options: "reset_mask", a boolean for each arm; "state" and "target" as of the single environment, one for all or one
                for each arm, or a State of all arms.

        Raises:
            InputError: for an option that does not exist or does not make sense, seeds that are none, seeds or a mask of another
                length, or seeds beside a State; the present episodes then go on.
        """
        start = find_start(options, self.setup, (self.num_envs, self.batch.plant.states), ("reset_mask",))
        start.check_seed(seed)
        mask = (options or {}).get("reset_mask", self.all)
        if np.shape(mask) != (self.num_envs,) or np.asarray(mask).dtype != bool:
            raise InputError(f"reset_mask of shape {np.shape(mask)}; give {self.num_envs} booleans")
        if not (self.started or np.all(mask)):
            raise InputError("reset_mask in the first reset: every arm has to be started once")
        chosen = self.every[np.asarray(mask)]
        if start.state is not None:
            return self._go_on(start, chosen)
        first = None if self.started else int(self.np_random.integers(2**62))
        seeds = seeds_of(first if seed is None else seed, self.num_envs)
        if first is not None:
            seeds = [first + i if one is None else one for i, one in enumerate(seeds)]
        self.batch.reset(chosen, [seeds[i] for i in chosen], start)
        if seed is not None and not is_list(seed):
            super().reset(seed=seeds[0])
        self.over[chosen] = False
        self.started = True
        return self.batch.observations.copy(), self._info(np.asarray(mask))

    def _go_on(self, start: Start, chosen: Array) -> tuple[Array, dict[str, Any]]:
        """Go on from a state of all arms, with other targets where they are given."""
        if len(chosen) < self.num_envs:
            raise InputError("reset_mask beside a State, which is one of all arms: leave out the mask")
        self.set_state(start.state)
        self.batch.aim(chosen, start)
        return self.batch.observations.copy(), self._info(self.all)

    def state(self) -> State:
        """Copy everything on which the next steps depend; `state().physical` has the [q, q̇, extra] of each arm.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
        """
        if not self.started:
            raise gym.error.ResetNeeded("state before reset: call envs.reset() first")
        return self.batch.state()

    def set_state(self, state: Any) -> None:
        """Go on from a state that this environment, or one with the same arguments, has returned.

        Raises:
            InputError: for a state of another environment or arm, or a value of another type.
        """
        self.batch.set_state(state)
        self.over = (self.batch.outcome[TERMINATED] > 0.0) | (self.batch.outcome[SAMPLE_COUNT] >= self.max_episode_steps)
        self.started = True

    @property
    def spec(self) -> EnvSpec | None:
        """Registration from which `gymnasium.make_vec` makes an equal environment, in values that JSON has."""
        return self._spec

    @spec.setter
    def spec(self, given: EnvSpec | None) -> None:
        self._spec = plain_spec(given, self.max_episode_steps)

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Draw each arm in its present shape (height, width, 3)."""
        if self.render_mode is None:
            gym.logger.warn('render() draws nothing without a mode: gym.make_vec(..., render_mode="rgb_array")')
            return None
        if self.view is None:
            self.view = View(self.setup, "rgb_array", self.setup.rate)
        pictures = (self.view.draw(self.batch, arm) for arm in range(self.num_envs))
        return tuple(picture for picture in pictures if picture is not None)

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Apply the commands actions · limit (arms, 1) for one sample.

        Raises:
            gymnasium.error.ResetNeeded: before the first reset, or for arms after the end of their episode that need a reset.
            InputError: for actions of another shape, that are not numbers, or beyond ±1e6; others are clipped.
        """
        before = self.over
        if self.autoreset_mode is AutoresetMode.DISABLED and before.any():
            raise gym.error.ResetNeeded('episodes are over: call envs.reset(options={"reset_mask": done}) first')
        rewards, terminated, truncated = self.move(actions)
        batch = self.batch
        if self.autoreset_mode is AutoresetMode.NEXT_STEP and before.any():
            batch.reset(self.every[before])
            rewards[before], terminated[before], truncated[before] = 0.0, False, False
            self.over &= ~before
        if self.autoreset_mode is AutoresetMode.SAME_STEP and self.over.any():
            return self._same_step(rewards, terminated, truncated)
        return batch.observations.copy(), rewards, terminated, truncated, self._info(self.all)

    def move(self, actions: Array) -> tuple[Array, Array, Array]:
        """Apply actions (arms, 1) for one sample and start nothing anew; return rewards, terminated and truncated (arms,).

        Raises:
            gymnasium.error.ResetNeeded: before the first reset.
            InputError: for actions of another shape, that are not numbers, or beyond ±1e6.
        """
        if not self.started:
            raise gym.error.ResetNeeded("step before reset: call envs.reset() first")
        batch = self.batch
        given = real_array(actions)
        if given is None or given.shape != (self.num_envs, 1):
            what = f"actions {actions!r}" if given is None else f"actions of shape {given.shape}"
            raise InputError(f"{what}; give one number from -1 to 1 for each arm, in shape ({self.num_envs}, 1)")
        values = np.ascontiguousarray(given).reshape(-1)
        arm = batch.request(values if values.dtype == np.float32 else values.astype(np.float64))
        if arm >= 0:
            raise InputError(f"action of arm {arm} = {actions[arm][0]}; give numbers from -1 to 1")
        batch.step()
        rewards = batch.outcome[REWARD].copy()
        terminated = batch.outcome[TERMINATED] > 0.0
        truncated = batch.outcome[SAMPLE_COUNT] >= self.max_episode_steps
        self.over = terminated | truncated
        return rewards, terminated, truncated

    @property
    def observations(self) -> Array:
        """Observations after the last step (arms, signals + 1), to be copied."""
        return self.batch.observations

    @property
    def lengths(self) -> Array:
        """Steps since the start of each arm's episode (arms,)."""
        return self.batch.outcome[SAMPLE_COUNT].astype(np.int64)

    def restart(self) -> None:
        """Start the next episode of every arm at the end of one."""
        self.batch.reset(self.every[self.over])
        self.over = np.zeros(self.num_envs, dtype=bool)

    def _same_step(
        self, rewards: Array, terminated: Array, truncated: Array
    ) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        over, last = self.over, np.full(self.num_envs, None, dtype=object)
        for i in self.every[over]:
            last[i] = self.batch.observations[i].copy()
        final = {"final_obs": last, "_final_obs": over.copy(), "final_info": self._info(over), "_final_info": over.copy()}
        self.restart()
        return self.batch.observations.copy(), rewards, terminated, truncated, self._info(self.all) | final

    def infos(self) -> dict[str, Any]:
        """Copy the quantities of the infos of all arms, by name (arms,)."""
        return self._info(self.all)

    def _info(self, mask: Array) -> dict[str, Any]:
        info: dict[str, Any] = self.batch.info()
        info["stuck"] = info["stuck"] > 0.0
        if mask is not self.all:
            for values in info.values():
                values[~mask] = 0
        info.update(dict.fromkeys(self.present, mask.copy()))
        return info

    def drawn_arm(self, arm: int) -> Arm:
        """Look up the machine that was drawn for the episode of arm number `arm`."""
        return self.batch.arm_of(arm)

    def close_extras(self, **kwargs: Any) -> None:
        """Dismiss the threads."""
        if "batch" in vars(self):  # Gymnasium before 1.3 closes also what was refused as it was made
            self.batch.close()
        self.view = None


def _mode(given: str | AutoresetMode) -> AutoresetMode:
    for mode in AutoresetMode if isinstance(given, str | AutoresetMode) else ():
        if given in (mode, mode.value, mode.name):
            return mode
    raise InputError(f"autoreset_mode = {given!r}; allowed: {', '.join(mode.value for mode in AutoresetMode)}")


@cache
def _task_class(name: str) -> type[FlexArmVectorEnv]:
    """Make the vector environment of a registered task, by the name of the class."""
    task = TASK_OF_CLASS[name]

    def __init__(self: FlexArmVectorEnv, num_envs: int = 1, arm: ArmLike = "thesis", **arguments: Any) -> None:
        refuse_task(task, arguments)
        FlexArmVectorEnv.__init__(self, num_envs, task, arm, **arguments)

    page = f"Many arms at the task {task.name}; see {task.title}Env and FlexArmVectorEnv."
    return type(name, (FlexArmVectorEnv,), {"__init__": __init__, "__doc__": page, "__module__": __name__})


def __getattr__(name: str) -> Any:
    if name not in TASK_OF_CLASS:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return _task_class(name)
