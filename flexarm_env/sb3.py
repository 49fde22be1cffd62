"""The vector environment as a VecEnv of Stable-Baselines3."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.envs.registration import load_env_creator
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from flexarm_env.env.infos import Infos, Step
from flexarm_env.env.seeds import seeds_of
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.registration import IDS, SHAPED
from flexarm_env.vector_env import FlexArmVectorEnv
from flexarm_env.wrappers import ShapedVector

try:
    from stable_baselines3.common.vec_env import VecEnv
except ModuleNotFoundError as error:
    if error.name != "stable_baselines3":  # it is installed, and lacks something itself
        raise
    line = "flexarm_env.sb3 needs Stable-Baselines3: pip install 'flexarm-env[train]'"
    raise ModuleNotFoundError(line, name=error.name) from None

Array = NDArray[Any]

#: Part of the info of a step that ends no episode.
GOING_ON = {"TimeLimit.truncated": False}


def make_vec(id: str, num_envs: int = 1, seed: int | None = None, **arguments: Any) -> FlexArmVecEnv:
    """Make arms for Stable-Baselines3's algorithms to train on.

    Args:
        id: of the environment.
        num_envs: arms.
        seed: of the first reset; arm i gets seed + i.
        arguments: of FlexArmVectorEnv.

    Raises:
        InputError: for an id of no environment of arms, a seed that is none, or arguments that do not exist or make no sense.

    Examples:
        >>> vec = make_vec("FlexArm/Slew-v0", 8, seed=0)
        >>> vec.reset().shape
        (8, 5)
        >>> vec.close()
    """
    _refuse_other(id)
    try:
        made = gym.make_vec(
            id, num_envs, vectorization_mode="vector_entry_point", autoreset_mode=AutoresetMode.SAME_STEP, **arguments
        )
    except gym.error.Error:
        raise InputError(f"no environment {id!r}{did_you_mean(str(id), (*IDS, *SHAPED))}") from None
    assert isinstance(made, FlexArmVectorEnv | ShapedVector)
    vec = FlexArmVecEnv(made)
    vec.seed(seed)
    return vec


def _refuse_other(id: str) -> None:
    """Refuse the id of an environment of another kind than arms."""
    spec = gym.registry.get(id)
    entry = spec.vector_entry_point if spec else FlexArmVectorEnv
    made = load_env_creator(entry) if isinstance(entry, str) else entry
    if made is None or (isinstance(made, type) and not issubclass(made, FlexArmVectorEnv | ShapedVector)):
        raise InputError(f"{id!r} is no environment of arms; allowed: {', '.join((*IDS, *SHAPED))}")


class FlexArmVecEnv(VecEnv):
    """Many arms, shaped or not, whose next episode starts in the step that ends one.

    Infos have the keys of the single environment's. At the end of an episode they also hold `terminal_observation`,
    `TimeLimit.truncated` and the `episode` statistics of a Monitor. `envs.batch.info()` has the true state of all arms at once.
    """

    def __init__(self, envs: FlexArmVectorEnv | ShapedVector) -> None:
        self.envs = envs
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)
        self.metadata |= {"render_fps": envs.metadata["render_fps"]}
        self.returns = np.zeros(envs.num_envs)
        self.began = time.perf_counter()
        self.actions: Array = np.zeros(envs.action_space.shape or ())
        self.next_seed: int | None = None

    def __getstate__(self) -> dict[str, Any]:
        # Another process has another clock.
        return vars(self) | {"began": time.perf_counter() - self.began}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, began=time.perf_counter() - state["began"])

    def seed(self, seed: int | None = None) -> list[int | None]:
        """Set the seed of the next reset: arm i gets seed + i.

        Raises:
            InputError: for a seed that is no whole number from 0 to 2⁶⁴ − 1.
        """
        seeds = seeds_of(seed, self.num_envs)
        self.next_seed = seed
        return seeds

    def reset(self) -> Array:
        """Start an episode of every arm; return observations (arms, signals + 1).

        Raises:
            InputError: for options, as set_options takes them, that do not exist or do not make sense.
        """
        observations, _ = self.envs.reset(seed=self.next_seed, options=self._given_options())
        self.next_seed = None
        self._reset_options()
        self.returns[:] = 0.0
        outcome = self.envs.batch.outcome.T.tolist()
        self.reset_infos = [self.envs.batch.info_of(column) for column in outcome]
        return observations

    def _given_options(self) -> dict[str, Any] | None:
        """Collect the options of the next reset, a list of one value for each arm under each name."""
        names = {tuple(sorted(each)) for each in self._options}
        if len(names) > 1:
            raise InputError(f"options of the arms have different names: {sorted(names)}; give all arms the same ones")
        return {name: [each[name] for each in self._options] for name in names.pop()} or None

    def step_async(self, actions: Array) -> None:
        """Set the actions (arms, numbers) of the next step."""
        self.actions = actions

    def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
        """Apply the actions; return observations, rewards, ends of episodes, and infos."""
        envs = self.envs
        rewards, terminated, truncated = envs.move(self.actions)
        done, last = envs.over, envs.observations
        self.returns += rewards
        infos = Infos(Step(GOING_ON, envs.batch.outcome.copy(), envs.batch.info_rows, envs.batch.info_of))
        ended = np.flatnonzero(done).tolist()
        lengths = envs.lengths if ended else ()
        elapsed = round(time.perf_counter() - self.began, 6)
        for i in ended:
            infos[i] |= {
                "terminal_observation": last[i].copy(),
                "TimeLimit.truncated": bool(truncated[i] and not terminated[i]),
                "episode": {"r": float(self.returns[i]), "l": int(lengths[i]), "t": elapsed},
            }
            self.returns[i] = 0.0
        if ended:
            envs.restart()
        for i in ended:
            self.reset_infos[i] = envs.batch.info_of(envs.batch.outcome[:, i].tolist())
        return envs.observations.copy(), rewards.astype(np.float32), done, infos  # type: ignore[return-value]

    def close(self) -> None:
        """Close the arms' environment."""
        self.envs.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Read an attribute of the arms' common environment, once for each arm."""
        value = getattr(self.envs, attr_name)
        return [value for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute of the arms' common environment."""
        setattr(self.envs, attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> list[Any]:
        """Call a method of the arms' common environment for each arm, with its number first."""
        return [getattr(self.envs, method_name)(i, *args, **kwargs) for i in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: type, indices: Any = None) -> list[bool]:
        """Return whether the wrapper is a Monitor, the work of which is done here; there are no others."""
        from stable_baselines3.common.monitor import Monitor

        return [wrapper_class is Monitor for _ in self._get_indices(indices)]

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """Draw each arm (height, width, 3), or return None for each without a render mode."""
        if self.render_mode is None:
            return [None] * self.num_envs
        return list(self.envs.render() or ())  # type: ignore[arg-type] # a wrapper's may be anything
