"""Long work in a process of its own, which tells how far it is and can be stopped at once."""

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
#: Time [s] that a process has to clear up before it is killed.
PATIENCE = 5.0
#: Time [s] that its children have after it to clear up behind themselves.
CLEARING = 1.0
RUNNING, DONE, FAILED, STOPPED = "running", "done", "failed", "stopped"


class Job:
    """Work that runs in another process.

    Args:
        title: for a person.
        work: called with a function that takes the share done and what is being done; what it returns is the result.

    Attributes:
        state: "running", "done", "failed" or "stopped".
        share: of the work that is done, 0 to 1.
        text: what is being done, or one line that says why it failed.
        result: what the work returned, once it is done.
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
        """Take in what the process has said; return whether anything changed."""
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
        """End the process and all that it has started."""
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
        self._pipe.close()  # upon which the process clears up and ends
        threading.Thread(target=self._reap, daemon=True).start()

    def _reap(self) -> None:
        self._process.join(PATIENCE)
        time.sleep(CLEARING)
        _kill(self._process.pid or 0)  # the group: children may outlive their leader
        self._process.join()


def _kill(leader: int) -> None:
    """End a process and the group that it leads, at once."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        if hasattr(os, "killpg"):
            os.killpg(leader, signal.SIGKILL)
        else:
            os.kill(leader, signal.SIGTERM)


def _run(pipe: Connection, work: bytes) -> None:
    """Do the work in this process, which leads a group of its own and ends with whoever started it."""
    if hasattr(os, "setsid"):
        os.setsid()
    over = threading.Event()
    threading.Thread(target=_end_with, args=(pipe, over), daemon=True).start()

    def say(share: float, text: str) -> None:
        with contextlib.suppress(OSError):
            pipe.send((RUNNING, (share, text)))

    try:
        answer: tuple[str, Any] = (DONE, cloudpickle.dumps(cloudpickle.loads(work)(say)))
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
    """Wait for the other end to close; interrupt the work, whose own processes and files are then cleared up."""
    with contextlib.suppress(EOFError, OSError):
        pipe.recv()
    if over.is_set():
        return
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # an interrupt within compiled code complains, to nobody's use
    signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    if not over.wait(PATIENCE):
        _kill(os.getpid())
