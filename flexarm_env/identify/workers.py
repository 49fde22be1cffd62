"""Processes and threads among which fits are spread."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from joblib import Parallel, delayed, parallel_config

#: A function and its positional arguments. Both must pickle.
Task = tuple[Callable[..., Any], tuple[Any, ...]]


@dataclass(frozen=True)
class Workers:
    """Processes for many tasks; threads for the columns of a Jacobian where only one fit runs.

    Attributes:
        jobs: processes or threads at once.
    """

    jobs: int = 1

    def map(self, tasks: Sequence[Task]) -> Iterator[Any]:
        """Yield the results of tasks in their order, from processes; a single task runs here, in threads."""
        if len(tasks) > 1:
            yield from Parallel(n_jobs=self.jobs, return_as="generator")(delayed(f)(*arguments) for f, arguments in tasks)
        elif tasks:
            ((function, arguments),) = tasks
            with self.threads():
                result = function(*arguments)
            yield result

    def threads(self) -> parallel_config:
        """Open a context in which columns of Jacobians are computed in threads: replays release the interpreter."""
        return parallel_config(backend="threading", n_jobs=self.jobs)
