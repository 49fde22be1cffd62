"""The environment classes of the registered tasks: each is FlexArmEnv at its task, with the task's page."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from flexarm_env.env.arguments import ArmLike
from flexarm_env.env.flexarm import FlexArmEnv
from flexarm_env.env.page import page_of
from flexarm_env.errors import InputError
from flexarm_env.tasks import TASKS, Task

#: Tasks by the names of their environment classes, such as "SlewEnv".
TASK_OF_CLASS = {f"{task.title}Env": task for task in TASKS.values()}


@cache
def task_env(name: str) -> type[FlexArmEnv]:
    """Make the environment class of a registered task, by the name of the class."""
    task = TASK_OF_CLASS[name]

    def __init__(self: FlexArmEnv, arm: ArmLike = "thesis", **arguments: Any) -> None:
        refuse_task(task, arguments)
        FlexArmEnv.__init__(self, task, arm, **arguments)

    return type(name, (FlexArmEnv,), {"__init__": __init__, "__doc__": page_of(task), "__module__": "flexarm_env.env"})


def refuse_task(own: Task, arguments: Mapping[str, Any]) -> None:
    """Refuse another task than an environment's own.

    Raises:
        InputError: naming both.
    """
    if "task" in arguments:
        raise InputError(f"task = {arguments['task']!r}: this environment's task is '{own.name}'; use FlexArmEnv for another")
