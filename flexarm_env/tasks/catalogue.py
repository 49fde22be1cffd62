"""Find the registered tasks: every `Task` of a file in this folder, by name."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Sequence

from flexarm_env.errors import InputError
from flexarm_env.tasks.task import Task

NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")


def registered_tasks(package: str, path: Sequence[str]) -> dict[str, Task]:
    """Collect the tasks that the modules of a package define, in the order of their names.

    Args:
        package: dotted name.
        path: its folders.

    Raises:
        InputError: for a name that makes no id, or that two tasks share.
    """
    found: dict[str, Task] = {}
    for module in pkgutil.iter_modules(path):
        for task in vars(importlib.import_module(f"{package}.{module.name}")).values():
            if isinstance(task, Task):
                if not NAME.fullmatch(task.name):
                    raise InputError(f"task '{task.name}' in {module.name}.py: write lower-case words joined by underscores")
                if found.setdefault(task.name, task) is not task:
                    raise InputError(f"task '{task.name}' in {module.name}.py exists already; give it another name")
    return {name: found[name] for name in sorted(found)}
