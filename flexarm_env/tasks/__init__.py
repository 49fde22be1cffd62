"""Tasks: start, target, reward and end of an episode. A file in this folder that defines a `Task` registers it."""

from __future__ import annotations

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.tasks.catalogue import registered_tasks
from flexarm_env.tasks.common_terms import COMMON_TERMS
from flexarm_env.tasks.reward import RewardTerm
from flexarm_env.tasks.task import CONTROL_RATE, RANDOM_PAYLOAD, Task

__all__ = ["COMMON_TERMS", "CONTROL_RATE", "RANDOM_PAYLOAD", "TASKS", "RewardTerm", "Task", "find_task"]

#: The registered tasks by name.
TASKS = registered_tasks(__name__, __path__)


def find_task(task: str | Task) -> Task:
    """Find a registered task by its name, or pass a task on.

    Raises:
        InputError: for a name that does not exist.

    Examples:
        >>> find_task("slew").duration
        5.0
    """
    if isinstance(task, Task):
        return task
    if not isinstance(task, str) or task not in TASKS:
        raise InputError(f"unknown task '{task}'{did_you_mean(str(task), TASKS)}")
    return TASKS[task]
