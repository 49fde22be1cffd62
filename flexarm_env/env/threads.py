"""Threads that share the arms of an environment, with the least overhead that Python allows."""

from __future__ import annotations

import threading
import time
import weakref
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from flexarm_env.env.shares import Arms, begin_step, finish_share, first_claim, wait_for_shares, wake, work_on_shares

#: Part of its share of the arms that the caller moves before it turns to the pool, and shares of the pool per thread.
OWN_SHARE, SHARES = 0.85, 8
LEAST_SHARE = 16


class Helper:
    """A thread that works when it is called.

    It holds no work while it sleeps, so that an environment dropped without close() is still collected.
    """

    def __init__(self) -> None:
        self.called = threading.Semaphore(0)
        self.work: Callable[[], None] | None = None
        self.dismissed = False
        threading.Thread(target=self._serve, daemon=True).start()

    def call(self, work: Callable[[], None]) -> None:
        """Wake the thread to do some work."""
        self.work = work
        self.called.release()

    def dismiss(self) -> None:
        """End the thread."""
        self.dismissed = True
        self.called.release()

    def _serve(self) -> None:
        while self.called.acquire() and not self.dismissed:
            work, self.work = self.work, None
            if work is not None:  # a call may come while it is still awake, and another soon after
                work()
            del work


def _dismiss(helpers: list[Helper]) -> None:
    while helpers:
        helpers.pop().dismiss()


class Crew:
    """The caller's thread and its helpers.

    Args:
        size: of the crew, the caller counted.
        count: of arms.
        move: moves arms on, see shares.work_on_shares.
        observe: rewards and observes them.
        arms: arrays of all arms.
    """

    def __init__(self, size: int, count: int, move: Any, observe: Any, arms: Arms) -> None:
        own = round(OWN_SHARE * count / size)
        share = max((count - own) // (SHARES * size), LEAST_SHARE)
        self.limits = [0, *range(own, count, share), count]
        self.shares, self.first = len(self.limits) - 1, first_claim(size)
        self.last = self.first + self.shares
        self.pool = np.zeros(self.last, dtype=np.int64)
        self.helpers = [Helper() for _ in range(size - 1)]
        common = (move, observe, arms, self.pool, np.array(self.limits), size)
        self.jobs = [partial(work_on_shares, *common, part) for part in range(1, size)]
        self.dismiss = weakref.finalize(self, _dismiss, self.helpers)

    def run(self, work: Callable[[int, int], None]) -> None:
        """Move all arms on; `work` moves those from first to last - 1 on in the caller's thread."""
        begin_step(self.pool, self.first)
        for part, (helper, job) in enumerate(zip(self.helpers, self.jobs, strict=True), start=1):
            if wake(self.pool, part):
                helper.call(job)
        place = self.first
        try:
            while place >= 0:
                share = place - self.first
                work(self.limits[share], self.limits[share + 1])
                place = finish_share(self.pool, place + 1, self.last)
        except BaseException:  # no helper is to be at work still when the next step begins
            while place >= 0:
                place = finish_share(self.pool, place + 1, self.last)
            raise
        finally:
            while not wait_for_shares(self.pool, self.shares):
                time.sleep(0.0)
