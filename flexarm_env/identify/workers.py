"""Processes and threads among which fits are spread."""

from __future__ import annotations

import math
import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import takewhile
from typing import Any

from joblib import Parallel, delayed, parallel_config

from flexarm_env.identify.deadline import Deadline

#: A function and its positional arguments. Both must pickle.
Task = tuple[Callable[..., Any], tuple[Any, ...]]
#: Time [s] between looks whether the process that started this one is still there.
LOOK = 0.5


@dataclass(frozen=True)
class Workers:
    """Processes for many tasks; threads for the columns of a Jacobian where only one fit runs.

    Attributes:
        jobs: processes or threads at once.
        deadline: after which no task starts that can be left out.
    """

    jobs: int = 1
    deadline: Deadline = field(default_factory=Deadline)

    def map(self, tasks: Sequence[Task]) -> Iterator[Any]:
        """Yield the results of tasks in their order, from processes; a single task runs here, in threads."""
        if len(tasks) > 1:
            yield from self._spread(tasks, "2 * n_jobs")
        elif tasks:
            ((function, arguments),) = tasks
            with self.threads():
                result = function(*arguments)
            yield result

    def map_in_time(self, tasks: Sequence[Task]) -> Iterator[Any]:
        """Yield the results of the first tasks: of those that start before the deadline."""
        if len(tasks) < 2 or not math.isfinite(self.deadline.limit):
            yield from () if self.deadline.is_over else self.map(tasks)
        elif not self.deadline.is_over:
            yield from self._spread(takewhile(lambda task: not self.deadline.is_over, tasks), "n_jobs")  # none waits

    def _spread(self, tasks: Iterable[Task], ahead: str) -> Iterator[Any]:
        calls = (delayed(_run)(os.getpid(), function, arguments) for function, arguments in tasks)
        yield from Parallel(n_jobs=self.jobs, return_as="generator", pre_dispatch=ahead)(calls)

    def threads(self) -> parallel_config:
        """Open a context in which columns of Jacobians are computed in threads: replays release the interpreter."""
        return parallel_config(backend="threading", n_jobs=self.jobs)


def _run(parent: int, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    if os.getppid() == parent:
        _end_with(parent)
    return function(*arguments)


@lru_cache(maxsize=1)
def _end_with(parent: int) -> None:
    """End this process soon after the one that started it: one that is killed tells its workers nothing."""

    def look() -> None:
        while os.getppid() == parent:
            time.sleep(LOOK)
        os._exit(1)

    threading.Thread(target=look, daemon=True).start()
