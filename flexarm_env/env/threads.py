"""Threads that wait between the steps of an environment, with as little between them and their work as Python allows."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Sequence


class Helper:
    """A thread that does one piece of work at a time.

    It holds no work while it waits, so that an environment that is dropped without close() is collected all the same.
    """

    def __init__(self) -> None:
        self.begin, self.done = threading.Lock(), threading.Lock()
        self.begin.acquire()
        self.done.acquire()
        self.work: Callable[[], None] | None = None
        self.error: BaseException | None = None
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while True:
            self.begin.acquire()
            work, self.work = self.work, None
            if work is None:
                return
            try:
                work()
            except BaseException as error:
                self.error = error
            del work
            self.done.release()


def _dismiss(helpers: list[Helper]) -> None:
    while helpers:
        helpers.pop().begin.release()


class Crew:
    """The caller's thread and its helpers.

    Args:
        size: of the crew, the caller counted.
    """

    def __init__(self, size: int) -> None:
        self.helpers = [Helper() for _ in range(size - 1)]
        self.dismiss = weakref.finalize(self, _dismiss, self.helpers)

    def run(self, parts: Sequence[Callable[[], None]]) -> bool:
        """Do all parts at once, the first of them here; return, when all are done, whether that one was done first."""
        for helper, part in zip(self.helpers, parts[1:], strict=True):
            helper.work = part
            helper.begin.release()
        waited = False
        try:
            parts[0]()
        finally:
            for helper in self.helpers:
                if not helper.done.acquire(blocking=False):
                    waited = True
                    helper.done.acquire()
        for helper in self.helpers:
            if helper.error is not None:
                error, helper.error = helper.error, None
                raise error
        return waited
