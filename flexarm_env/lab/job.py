"""Long work in a separate process that reports its progress and can be stopped at once."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

import cloudpickle

from flexarm_env.errors import InputError

Progress = Callable[[float, str], None]
#: Time [s] that a process has for its cleanup before it is killed.
GRACE_PERIOD = 5.0
#: Time [s] that its children have for theirs after it has ended.
CHILDREN_GRACE_PERIOD = 1.0
RUNNING, DONE, FAILED, STOPPED = "running", "done", "failed", "stopped"


class Job:
    """Work that runs in another process.

    Args:
        title: shown to the user.
        work: returns the result; called with a function that takes the share done and the name of the current stage.

    Attributes:
        state: "running", "done", "failed" or "stopped".
        share: of the work done, 0 to 1.
        text: the current stage, or one line with the reason of a failure.
        result: of the work, once it is done.
    """

    def __init__(self, title: str, work: Callable[[Progress], Any]) -> None:
        self.title, self.state, self.share, self.text = title, RUNNING, 0.0, ""
        self.result: Any = None
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_run, args=(theirs, cloudpickle.dumps(work)))
        self._process.start()
        theirs.close()

    def poll(self) -> bool:
        """Read the messages of the process; return whether there were any."""
        changed = False
        while self.state == RUNNING:
            try:
                if not self._pipe.poll():
                    break
                kind, content = self._pipe.recv()
            except (EOFError, OSError):
                kind, content = FAILED, "the work ended without a word; was there memory enough?"
            changed = True
            self._take(kind, content)
        return changed

    def stop(self) -> None:
        """End the process and its children."""
        if self.state == RUNNING:
            self.state, self.text = STOPPED, "stopped"
            self._end()

    def _take(self, kind: str, content: Any) -> None:
        if kind == RUNNING:
            self.share, self.text = content
            return
        self.state = kind
        if kind == DONE:
            self.share, self.result = 1.0, cloudpickle.loads(content)
        else:
            self.text = content
        self._end()

    def _end(self) -> None:
        self._pipe.close()  # the process then cleans up and ends
        threading.Thread(target=self._reap, daemon=True).start()

    def _reap(self) -> None:
        self._process.join(GRACE_PERIOD)
        time.sleep(CHILDREN_GRACE_PERIOD)
        _kill(self._process.pid or 0)  # the group: children may outlive their leader
        self._process.join()


def _kill(leader: int) -> None:
    """Kill a process and the group that it leads."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        if hasattr(os, "killpg"):
            os.killpg(leader, signal.SIGKILL)
        else:
            os.kill(leader, signal.SIGTERM)


def _run(pipe: Connection, work: bytes) -> None:
    """Do the work in this process, which leads its own group and ends with its parent."""
    if hasattr(os, "setsid"):
        os.setsid()
    over = threading.Event()
    threading.Thread(target=_end_with, args=(pipe, over), daemon=True).start()

    def report(share: float, text: str) -> None:
        with contextlib.suppress(OSError):
            pipe.send((RUNNING, (share, text)))

    try:
        answer: tuple[str, Any] = (DONE, cloudpickle.dumps(cloudpickle.loads(work)(report)))
    except InputError as error:
        answer = (FAILED, str(error))
    except KeyboardInterrupt:
        return
    except Exception as error:
        answer = (FAILED, f"a fault of the program, not of your input: {type(error).__name__}: {error}")
    over.set()
    with contextlib.suppress(OSError):
        pipe.send(answer)


def _end_with(pipe: Connection, over: threading.Event) -> None:
    """Wait for the other end to close, then interrupt the work, which cleans up its processes and files."""
    with contextlib.suppress(EOFError, OSError):
        pipe.recv()
    if over.is_set():
        return
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # an interrupt within compiled code prints a useless warning
    signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    if not over.wait(GRACE_PERIOD):
        _kill(os.getpid())
