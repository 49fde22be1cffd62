"""Work that is counted, or limited by the processor's time of this process alone, so that other programs do not matter."""

from __future__ import annotations

import contextlib
import signal
import sys
from collections.abc import Callable, Iterator
from typing import Any

#: Time [s] of the processor after which work counts as endless: what is held to it takes less than 0.1 s, and ten or more in time
#: that grows with the square of its length.
ENDLESS = 3.0


@contextlib.contextmanager
def ends(seconds: float = ENDLESS) -> Iterator[None]:
    """Break off work that takes longer than a time of the processor.

    Raises:
        AssertionError: where it is broken off.
    """

    def fail(*_: object) -> None:
        raise AssertionError(f"no end after {seconds:g} s of the processor")

    before = signal.signal(signal.SIGVTALRM, fail)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def calls(work: Callable[[], Any]) -> int:
    """Count the calls of functions, of Python and of C, that work makes."""
    count = 0

    def add(_: object, event: str, __: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(add)
    try:
        work()
    finally:
        sys.setprofile(before)
    return count
