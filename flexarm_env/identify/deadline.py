"""Time that a search may take."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from flexarm_env.errors import InputError

#: Reads a clock [s].
Clock = Callable[[], float]


@dataclass(frozen=True)
class Deadline:
    """When a search is to end.

    Attributes:
        limit: time [s] from the beginning; infinite where there is none.
        clock: by which it is measured.
        began: what the clock showed.

    Example:
        >>> Deadline.after(None).is_over, Deadline.after(1e-9).is_over
        (False, True)
    """

    limit: float = math.inf
    clock: Clock = time.perf_counter
    began: float = field(default_factory=time.perf_counter)

    @classmethod
    def after(cls, limit: float | None, clock: Clock = time.perf_counter) -> Deadline:
        """Begin now.

        Args:
            limit: time [s]; None for as long as it takes.
            clock: by which it is measured.

        Raises:
            InputError: for a limit that is no time.
        """
        if limit is not None and not 0 < limit < math.inf:
            raise InputError(f"a time limit of {limit:g} s; give a number of seconds above 0, or none to search to the end")
        return cls(math.inf if limit is None else limit, clock, clock())

    @property
    def elapsed(self) -> float:
        """Time [s] since the beginning."""
        return self.clock() - self.began

    @property
    def is_over(self) -> bool:
        """Whether the limit has passed."""
        return self.elapsed >= self.limit
