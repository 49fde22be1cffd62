"""Environments as the shipped policies were trained on them: entry points such as SlewShaped and SlewShapedVector."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

from flexarm_env.arm_file import config_folders
from flexarm_env.env.arguments import ArmLike, find_arm
from flexarm_env.env.flexarm import FlexArmEnv
from flexarm_env.env.task_envs import refuse_task
from flexarm_env.errors import InputError
from flexarm_env.tasks import TASKS, Task
from flexarm_env.vector_env import FlexArmVectorEnv
from flexarm_env.wrappers.arms import draws_of
from flexarm_env.wrappers.options import ArmsOptions, InterfaceOptions, RewardOptions, read_options
from flexarm_env.wrappers.shaped import Shaped
from flexarm_env.wrappers.shaped_vector import ShapedVector

#: Tasks by the names of their entry points.
TASK_OF_ENTRY = {f"{task.title}{kind}": (task, kind) for task in TASKS.values() for kind in ("Shaped", "ShapedVector")}


@dataclass(frozen=True)
class Trained:
    """Sections of the configuration by which a task's policies were trained."""

    arms: ArmsOptions = ArmsOptions()  # noqa: RUF009 - frozen
    interface: InterfaceOptions = InterfaceOptions()  # noqa: RUF009 - frozen
    reward: RewardOptions = RewardOptions()  # noqa: RUF009 - frozen


@cache
def trained_on(task: str) -> Trained:
    """Read the configuration of a task's shipped policies; the default options for a task that has none."""
    for folder in config_folders("agents"):
        path = folder / f"ppo_{task}.toml"
        if path.is_file():
            table = tomllib.loads(path.read_text(encoding="utf-8"))
            return read_options(Trained, {name: table[name] for name in ("arms", "interface", "reward") if name in table})
    return Trained()


def roomy(task: Task) -> Task:
    """Make the task without an end where the arm turns too far, as it is trained."""
    return replace(task, range=math.inf)


def shaped(
    task: Task,
    /,
    arm: ArmLike = "thesis",
    interface: Mapping[str, Any] | None = None,
    reward: Mapping[str, Any] | None = None,
    **arguments: Any,
) -> Shaped:
    """Make one arm at a task as its shipped policies were trained on it.

    Args:
        task: of the arm.
        arm: the machine.
        interface: table of InterfaceOptions, over those of the shipped policies.
        reward: the same of RewardOptions.
        arguments: of FlexArmEnv; arms are drawn as in training where none of randomise, vary and disturb is given.

    Raises:
        InputError: for arguments or options that do not exist or do not make sense.
    """
    given, options = _given(task, arm, arguments), _options(task, interface, reward)
    return Shaped(FlexArmEnv(roomy(task), arm, **given), *options)


def shaped_vector(
    task: Task,
    /,
    num_envs: int = 1,
    arm: ArmLike = "thesis",
    interface: Mapping[str, Any] | None = None,
    reward: Mapping[str, Any] | None = None,
    *,
    max_episode_steps: int | None = None,
    **arguments: Any,
) -> ShapedVector:
    """Make many arms at a task as its shipped policies were trained on them; see shaped."""
    given, options = _given(task, arm, arguments), _options(task, interface, reward)
    return ShapedVector(FlexArmVectorEnv(num_envs, roomy(task), arm, **given), *options, max_episode_steps=max_episode_steps)


def _given(task: Task, arm: ArmLike, arguments: Mapping[str, Any]) -> dict[str, Any]:
    refuse_task(task, arguments)
    drawn = {} if {"randomise", "vary", "disturb"} & arguments.keys() else draws_of(trained_on(task.name).arms, find_arm(arm))
    return {"physical": True, **drawn, **arguments}


def _options(
    task: Task, interface: Mapping[str, Any] | None, reward: Mapping[str, Any] | None
) -> tuple[InterfaceOptions, RewardOptions]:
    found = trained_on(task.name)
    return (
        read_options(InterfaceOptions, vars(found.interface) | _table("interface", interface)),
        read_options(RewardOptions, vars(found.reward) | _table("reward", reward)),
    )


def _table(name: str, given: Any) -> dict[str, Any]:
    if not isinstance(given, Mapping | None):
        raise InputError(f"{name} = {given!r}; give a table of options by name")
    return dict(given or {})


def __getattr__(name: str) -> Callable[..., Any]:
    if name not in TASK_OF_ENTRY:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    task, kind = TASK_OF_ENTRY[name]
    return partial(shaped if kind == "Shaped" else shaped_vector, task)
