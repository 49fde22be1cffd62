"""Threads in which replays run side by side: they release the interpreter."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

from threadpoolctl import threadpool_limits

Result = TypeVar("Result")
_pool: ContextVar[ThreadPoolExecutor | None] = ContextVar("pool", default=None)


@contextmanager
def threads(count: int) -> Iterator[None]:
    """Open a context in which `in_threads` uses so many threads.

    Linear algebra takes one thread there: its matrices are narrow, and more threads sum in another order on other machines.
    """
    with ExitStack() as context:
        context.enter_context(threadpool_limits(limits=1, user_api="blas"))
        if count > 1:
            token = _pool.set(context.enter_context(ThreadPoolExecutor(count)))
            context.callback(_pool.reset, token)
        yield


def in_threads(function: Callable[..., Result], tasks: Iterable[tuple[Any, ...]]) -> list[Result]:
    """Call a function with the arguments of each task, in the threads of the context that is open here.

    Without a context, as in one of those threads, it is called one by one.

    Example:
        >>> with threads(2):
        ...     in_threads(pow, [(2, 4), (3, 2)])
        [16, 9]
    """
    pool = _pool.get()
    return list((pool.map if pool else map)(lambda task: function(*task), tasks))
