"""Processes that a test has started, and those that these have started."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

#: For tests of processes that only the system can list.
LISTED = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="this system does not list processes in /proc")


def is_alive(process: int) -> bool:
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


def descendants(process: int) -> list[int]:
    """List the processes that a process has started, and those that these have started."""
    try:
        own = [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        own = []
    return [found for child in own for found in (child, *descendants(child))]


def command_line(process: int) -> str:
    """The command of a process, "" for one that has ended."""
    try:
        return Path(f"/proc/{process}/cmdline").read_bytes().decode(errors="replace").replace("\0", " ")
    except OSError:
        return ""


def wait_for(condition: Callable[[], bool], patience: float) -> None:
    """Wait until a condition holds, no longer than a time [s]."""
    until = time.monotonic() + patience
    while not condition() and time.monotonic() < until:
        time.sleep(0.02)
