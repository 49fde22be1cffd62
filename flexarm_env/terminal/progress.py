"""A progress bar on stderr, where stderr is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[float, str], None]
#: Time [s] from which the time left is estimated.
FIRST = 2.0


@contextmanager
def progress(title: str) -> Iterator[Progress | None]:
    """Show a bar while the block runs; yield the function that moves it, or None where stderr is no terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    with _bar(title) as move:
        yield move


def time_left(elapsed: float, done: float) -> str:
    """Estimate the time left from the share that is done, as if the rest went as fast.

    A share that stands still makes the estimate grow.

    Example:
        >>> time_left(10.0, 0.25), time_left(300.0, 0.5), time_left(1.0, 0.5), time_left(10.0, 0.0)
        ('about 30 s left', 'about 5 min left', '', '10 s so far')
    """
    if elapsed < FIRST:
        return ""
    if not 0.0 < done <= 1.0:
        return f"{elapsed:.0f} s so far"
    left = elapsed * (1.0 - done) / done
    return f"about {left:.0f} s left" if left < 100.0 else f"about {left / 60.0:.0f} min left"


@contextmanager
def _bar(title: str) -> Iterator[Progress]:
    """Show a bar that a thread of its own draws several times a second."""
    from rich.console import Console
    from rich.progress import BarColumn, ProgressColumn, SpinnerColumn, Task, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar
    from rich.text import Text

    class TimeLeft(ProgressColumn):
        def render(self, task: Task) -> Text:
            return Text(time_left(task.elapsed or 0.0, task.completed))

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeLeft())
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=1.0)

        def move(done: float, text: str = "") -> None:
            share = min(max(done, bar.tasks[0].completed), 1.0)
            bar.update(task, completed=share, description=f"{title}: {text}" if text else title)

        yield move
