"""Processes and threads among which fits are spread."""

from __future__ import annotations

import math
import os
import signal
import threading
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from itertools import takewhile
from multiprocessing import resource_tracker
from typing import Any, Literal

from joblib import Parallel, delayed
from joblib.externals.loky.backend import resource_tracker as loky_tracker
from joblib.externals.loky.process_executor import TerminatedWorkerError

from flexarm_env.errors import InputError
from flexarm_env.identify.deadline import Deadline
from flexarm_env.identify.threads import threads

#: A function and its positional arguments. Both must pickle.
Task = tuple[Callable[..., Any], tuple[Any, ...]]
#: Time [s] between looks whether the process that started this one is still there.
LOOK = 0.5
#: How joblib's warning begins that it replaces a process, one that grew by some 300 MB.
REPLACED = "A worker stopped while some jobs were given to the executor"


@dataclass(frozen=True)
class Workers:
    """Processes for many tasks; threads for the replays of each.

    Attributes:
        jobs: processes or threads at once.
        deadline: after which no task starts that can be left out.
        batch: tasks that a process is handed at once, "auto" by the time that the first ones take.
    """

    jobs: int = 1
    deadline: Deadline = field(default_factory=Deadline)
    batch: int | Literal["auto"] = "auto"

    def __post_init__(self) -> None:
        if isinstance(self.jobs, bool) or not isinstance(self.jobs, int) or self.jobs < 1:
            raise InputError(f"jobs is {self.jobs!r}; give a whole number from 1 up")

    def map(self, tasks: Sequence[Task]) -> Iterator[Any]:
        """Yield the results of tasks in their order, from processes; a single task runs here, in threads."""
        if len(tasks) > 1:
            yield from self.spread(tasks)
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
            yield from self.spread(takewhile(lambda task: not self.deadline.is_over, tasks), "n_jobs")  # none waits

    def spread(self, tasks: Iterable[Task], ahead: str = "2 * n_jobs") -> Iterator[Any]:
        """Yield the results of tasks in their order, from processes that end with this one; for one job, from this process.

        Where an engine is around this one, such as Dask, joblib hands it tasks of any number of jobs. With one job none are: its
        workers would wait for each other.

        Args:
            tasks: functions and their arguments.
            ahead: tasks that may wait in a process, as joblib writes it.

        Raises:
            InputError: where a process was killed, as by a system that is short of memory.
        """
        if self.jobs == 1:
            for function, arguments in tasks:
                with self.threads():
                    result = function(*arguments)
                yield result
            return
        # joblib warns in the thread that brings results: where warnings are errors it would die, and none would ever come.
        warnings.filterwarnings("ignore", REPLACED, UserWarning)
        calls = (delayed(function)(*arguments) for function, arguments in tasks)
        watched = {"batch_size": self.batch, "initializer": _end_with, "initargs": (os.getpid(),)}
        with ExitStack() as interrupts:
            interrupts.enter_context(_interrupts_held())
            results = Parallel(n_jobs=self.jobs, return_as="generator", pre_dispatch=ahead, **watched)(calls)
            with closing(results):
                interrupts.close()
                try:
                    yield from results
                except TerminatedWorkerError:
                    raise InputError("a worker process was killed; was there memory enough? try --jobs 1") from None

    @contextmanager
    def threads(self) -> Iterator[None]:
        """Open a context in which replays run in threads."""
        with threads(self.jobs):
            yield


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Hold back Ctrl-C and a termination until the end.

    Processes that start meanwhile never meet Ctrl-C, which a terminal sends to them, too: they end with this one.
    """
    came: list[int] = []
    with ExitStack() as restored:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                before = signal.signal(number, lambda number, frame: came.append(number))
                restored.callback(signal.signal, number, before or signal.SIG_DFL)
        if hasattr(signal, "pthread_sigmask"):
            for tracker in (resource_tracker, loky_tracker):
                tracker.ensure_running()  # its start lets interrupts through again
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            restored.callback(signal.pthread_sigmask, signal.SIG_SETMASK, mask)
        yield
    if came:
        signal.raise_signal(came[0])


def _end_with(parent: int) -> None:
    """End this process soon after the one that started it: one that is killed tells its workers nothing."""

    def look() -> None:
        while os.getppid() == parent:
            time.sleep(LOOK)
        os._exit(1)

    threading.Thread(target=look, daemon=True).start()
