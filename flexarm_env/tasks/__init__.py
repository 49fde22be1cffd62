"""Tasks: where an episode starts, what is asked, what is rewarded and when it ends. They know nothing of the physics."""

from __future__ import annotations

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.tasks.damp import DAMP
from flexarm_env.tasks.slew import SLEW
from flexarm_env.tasks.task import REWARD_TERMS, Task
from flexarm_env.tasks.track import TRACK

__all__ = ["REWARD_TERMS", "TASKS", "Task", "find_task"]

TASKS = {task.name: task for task in (SLEW, TRACK, DAMP)}


def find_task(task: str | Task) -> Task:
    """Return a task by its name, or the task itself.

    Raises:
        InputError: for a name that does not exist.
    """
    if isinstance(task, Task):
        return task
    if not isinstance(task, str) or task not in TASKS:
        raise InputError(f"unknown task '{task}'{did_you_mean(str(task), TASKS)}")
    return TASKS[task]
