"""Arms at a task as a VecEnv of Stable-Baselines3: features in, actions out, with all episodes in step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from agents.learning.options import Plan
from flexarm_env.arm import Arm
from flexarm_env.tasks import TASKS
from flexarm_env.trials.sets import FIRST_SEED
from flexarm_env.vector_env import FlexArmVectorEnv
from flexarm_env.wrappers import ShapedVector
from flexarm_env.wrappers.arms import arms_of, draws_of
from flexarm_env.wrappers.interface import squeezed
from flexarm_env.wrappers.registered import roomy

Array = NDArray[Any]

RATE = 200.0
#: Seeds of each run: those of training stay below those of evaluation, and no two runs share any.
SEEDS_EACH = 10_000_000
#: Delay [s] that is 1 among the critic's privileged inputs.
LONG_DELAY = 0.01
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
        self.groups = groups_of(plan, arm)
        first = self.groups[0]
        self.interface = first.shaping.interface
        self.repeat, self.steps = plan.interface.repeat, first.shaping.steps
        self.actions_in_all = plan.actions
        self.privileged = plan.interface.privileged and plan.algorithm == "ppo"
        self.first_seed, self.next_episode, self.step_number = seed * SEEDS_EACH, 0, 0
        #: Mean over all arms of the last episodes' returns; None before the first end.
        self.mean_return: float | None = None
        #: Delay of each arm over LONG_DELAY, beside the constants that are drawn for it.
        late = np.repeat(plan.arms.delays, [group.num_envs for group in self.groups][: len(plan.arms.delays)])
        self.delays = late[:, None] / LONG_DELAY if len(late) else np.zeros((plan.at_once, 0))
        ranges = len(first.arms.setup.variation.ranges) + self.delays.shape[1]
        self.width = self.interface.size + (len(FINE_TRUTH) + ranges if self.privileged else 0)
        super().__init__(plan.at_once, *spaces_of(self.width, plan.interface.actions))

    def reset(self) -> Array:
        """Start the next episode of all arms; return the inputs of policy and critic (arms, width)."""
        count = self.num_envs
        seed = self.first_seed + self.next_episode * count % SEEDS_EACH
        share = min(self.next_episode * count * self.steps / self.actions_in_all, 1.0)
        self.next_episode += 1
        for group in self.groups:
            group.begin(seed % FIRST_SEED, share)
            seed += group.num_envs
        batches = [group.batch for group in self.groups]
        drawn = np.array([batch.draws_of(i) for batch in batches for i in range(batch.count)]).reshape(count, -1)
        self.draws = np.concatenate([drawn, self.delays], axis=1)
        self.returns, self.step_number = np.zeros(count), 0
        self.tip = self._info("tip_deflection")
        return self._observe()

    def step_async(self, actions: Array) -> None:
        """Set the actions (arms, 1 or 2) of the next step."""
        self.actions = actions

    def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
        """Hold the actions for `repeat` samples; return observations, rewards, ends of episodes, and infos."""
        places = np.cumsum([group.num_envs for group in self.groups])[:-1]
        parts = np.split(self.actions, places)
        rewards = np.concatenate([group.move(part)[0] for group, part in zip(self.groups, parts, strict=True)])
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
        seen = np.concatenate([group.observations for group in self.groups])
        if not self.privileged:
            return seen
        before, self.tip = self.tip, self._info("tip_deflection")
        truth = (self._info("target") - self._info("hub_angle"), self._info("hub_speed"), self.tip, self.tip - before)
        hidden = [squeezed(values, fine)[:, None] for values, fine in zip(truth, FINE_TRUTH, strict=True)]
        return np.concatenate([seen, *hidden, self.draws], axis=1, dtype=np.float32)

    def _info(self, name: str) -> Array:
        """Look up a quantity of the infos of all arms (arms,)."""
        return np.concatenate([group.batch.outcome[group.batch.info_rows[name]] for group in self.groups])

    def close(self) -> None:
        """Close the arms' environments."""
        for group in self.groups:
            group.close()

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


def groups_of(plan: Plan, arm: Arm) -> list[ShapedVector]:
    """Make the arms of a plan, those with the same delay together."""
    machines = arms_of(plan.arms, arm)
    counts = [len(part) for part in np.array_split(np.arange(plan.at_once), len(machines))]
    return [
        ShapedVector(
            FlexArmVectorEnv(
                count, roomy(TASKS[plan.task]), machine, prior=arm, control_rate=RATE, physical=True, **draws_of(plan.arms, arm)
            ),
            plan.interface,
            plan.reward,
        )
        for machine, count in zip(machines, counts, strict=True)
    ]
