"""Counts and times of the parts of a diagnosis, by its stages.

Parts and stages are functions of the package. While a case runs, each is replaced by one that counts and calls it; the package
itself contains no counters. Tasks of other processes bring their counts back with their results.
"""

from __future__ import annotations

import contextlib
import importlib
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any
from unittest.mock import patch

from flexarm_env.identify.workers import Task, Workers

IDENTIFY = "flexarm_env.identify"
#: Functions whose calls are counted, with the CPU time of each call less that of the parts inside it.
PARTS = {
    "residual": [f"{IDENTIFY}.calibrate.objective:Objective._whitened"],
    "initial state": [f"{IDENTIFY}.replay.start_fit:Stretch.fit", f"{IDENTIFY}.replay.start_fit:Stretch.follow"],
    "plant": ["flexarm_env.plant.plant:Plant._compile"],
    "observer": [f"{IDENTIFY}.replay.observer:physical_gains"],
    "replay": ["flexarm_env.plant.plant:Plant.play"],
}
#: Functions that are stages. The innermost counts.
STAGES = {
    "prepare": [f"{IDENTIFY}.diagnose:prepare"],
    "inspect": [f"{IDENTIFY}.diagnose:inspect_recordings"],
    "constants": [f"{IDENTIFY}.calibrate.calibrator:Calibrator.choose_hold_out"],
    "screen": [f"{IDENTIFY}.select.search:starts_of_search", f"{IDENTIFY}.select.search:screen"],
    "fit effects": [f"{IDENTIFY}.select.search:nearest", f"{IDENTIFY}.select.search:others"],
    "accept": [f"{IDENTIFY}.select.search:Search._accept", f"{IDENTIFY}.select.search:Search._recalibrate"],
    "combine": [f"{IDENTIFY}.select.search:Search.combine"],
    "swap, drop": [f"{IDENTIFY}.select.search:Search.swap", f"{IDENTIFY}.select.search:Search.drop_useless"],
    "conclude": [f"{IDENTIFY}.diagnose:conclude"],
    "detection limits": [f"{IDENTIFY}.diagnose:with_outlook"],
}
#: What comes in no stage.
REST = "rest"
#: A part inside the initial state has a name of its own: the replays of its fit are no replays of a recording.
INSIDE = "initial state"


class Counts:
    """Calls and CPU seconds of parts since the last look. Threads add to one sum.

    Attributes:
        calls: by part.
        seconds: CPU time by part, less that of the parts inside it.
        elsewhere: CPU time of tasks in other processes, from the start.
    """

    def __init__(self) -> None:
        self.calls: Counter[str] = Counter()
        self.seconds: Counter[str] = Counter()
        self.elsewhere = 0.0
        self._lock = threading.Lock()
        self._inside = threading.local()

    def counted(self, part: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a function: count its calls and its own CPU time."""

        def wrapper(*arguments: Any, **named: Any) -> Any:
            outer: list[list[Any]] = self._inside.__dict__.setdefault("stack", [])
            name = f"{part} of {INSIDE}" if any(frame[0] == INSIDE for frame in outer) else part
            outer.append([part, 0.0])
            began = time.thread_time()
            try:
                return function(*arguments, **named)
            finally:
                spent = time.thread_time() - began
                _, parts = outer.pop()
                if outer:
                    outer[-1][1] += spent
                with self._lock:
                    self.calls[name] += 1
                    self.seconds[name] += spent - parts

        return wrapper

    def add(self, calls: Counter[str], seconds: Counter[str], cpu_seconds: float) -> None:
        """Add counts of another process, and the CPU time that it took."""
        with self._lock:
            self.calls += calls
            self.seconds += seconds
            self.elsewhere += cpu_seconds

    def take(self) -> tuple[Counter[str], Counter[str]]:
        """Give the counts since the last look."""
        with self._lock:
            taken = self.calls, self.seconds
            self.calls, self.seconds = Counter(), Counter()
        return taken


class Stages:
    """Wall time of stages, and the counts of parts in each.

    Attributes:
        seconds: wall time by stage.
        parts: calls and CPU seconds of parts, by stage.
    """

    def __init__(self, counts: Counts) -> None:
        self.seconds: Counter[str] = Counter()
        self.parts: dict[str, tuple[Counter[str], Counter[str]]] = {}
        self._counts, self._stack, self._since = counts, [REST], time.perf_counter()
        self._began = time.process_time()

    @property
    def cpu_seconds(self) -> float:
        """CPU time from the start, of all processes."""
        return time.process_time() - self._began + self._counts.elsewhere

    def staged(self, stage: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a function: what it does belongs to a stage."""

        def wrapper(*arguments: Any, **named: Any) -> Any:
            self.close()
            self._stack.append(stage)
            try:
                return function(*arguments, **named)
            finally:
                self.close()
                self._stack.pop()

        return wrapper

    def close(self) -> None:
        """Book time and counts so far under the present stage."""
        now, stage = time.perf_counter(), self._stack[-1]
        self.seconds[stage] += now - self._since
        self._since = now
        calls, seconds = self.parts.setdefault(stage, (Counter(), Counter()))
        more_calls, more_seconds = self._counts.take()
        calls.update(more_calls)
        seconds.update(more_seconds)


def _replaced(place: str, wrap: Callable[[Callable[..., Any]], Callable[..., Any]]) -> Any:
    """Replace the function at a place, "module:name" or "module:class.name", within a context."""
    module, _, path = place.partition(":")
    owner: Any = importlib.import_module(module)
    *classes, name = path.split(".")
    for part in classes:
        owner = getattr(owner, part)
    return patch.object(owner, name, wrap(getattr(owner, name)))


@contextlib.contextmanager
def counting_parts(counts: Counts) -> Iterator[None]:
    """Count parts within a context."""
    with contextlib.ExitStack() as stack:
        for part, places in PARTS.items():
            for place in places:
                stack.enter_context(_replaced(place, lambda function, part=part: counts.counted(part, function)))
        yield


@contextlib.contextmanager
def counting() -> Iterator[Stages]:
    """Count parts by stages within a context, those of other processes too."""
    counts = Counts()
    stages = Stages(counts)
    map_tasks = Workers.map

    def map_counted(workers: Workers, tasks: Sequence[Task]) -> Iterator[Any]:
        if len(tasks) < 2 or workers.jobs == 1:  # run here
            yield from map_tasks(workers, tasks)
            return
        for result, *more in map_tasks(workers, [(_counted_there, task) for task in tasks]):
            counts.add(*more)
            yield result

    with contextlib.ExitStack() as stack:
        stack.enter_context(counting_parts(counts))
        stack.enter_context(patch.object(Workers, "map", map_counted))
        for stage, places in STAGES.items():
            for place in places:
                stack.enter_context(_replaced(place, lambda function, stage=stage: stages.staged(stage, function)))
        yield stages
        stages.close()


def _counted_there(function: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, Counter[str], Counter[str], float]:
    """Run a task in another process; give its result, the counts of its parts, and its CPU time."""
    counts, began = Counts(), time.process_time()
    with counting_parts(counts):
        result = function(*arguments)
    return result, *counts.take(), time.process_time() - began
