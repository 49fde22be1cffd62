"""How a program that a shell starts ends: its exit code, and one line on stderr for every end but success."""

from __future__ import annotations

import functools
import os
import re
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import Any

from flexarm_env.errors import InputError

#: As shells count: 128 and the number of the signal.
DONE, NO, BAD_INPUT, STOPPED, TERMINATED = 0, 1, 2, 130, 143

#: Characters of a line; the input that it repeats may be of any length.
LONGEST_LINE = 2000
Arguments = Sequence[str] | None
_WITHOUT_VALUE = re.compile(r"(--[\w-]+)=\s*")


class Stop(KeyboardInterrupt):
    """Ctrl-C or a termination. Of a plain KeyboardInterrupt that C code has seen the interpreter dies, with no exit code."""


@dataclass(frozen=True)
class Program:
    """A program by its name.

    Attributes:
        name: in front of every line; "" for none.
        stopped: the line after Ctrl-C or a termination.
    """

    name: str = ""
    stopped: str = "stopped"

    def __call__(self, main: Callable[[Sequence[str]], int | None]) -> Callable[..., int]:
        """Make a main function that leaves every error as one line and an exit code, without arguments for those of the shell."""

        @functools.wraps(main)
        def guarded(arguments: Arguments = None) -> int:
            if arguments is not None:
                return self.run(main, arguments)
            code = self.run(main, sys.argv[1:])
            if code in (STOPPED, TERMINATED):  # who cannot wait for the interpreter's end presses Ctrl-C again
                discard_stdout()
                sys.unraisablehook = lambda error: None
                threading.excepthook = lambda error: None
                for number in (signal.SIGINT, signal.SIGTERM):
                    signal.signal(number, lambda number, frame: os._exit(code))
            return code

        return guarded

    def run(self, main: Callable[[Sequence[str]], int | None], arguments: Sequence[str]) -> int:
        """Run a main function; return its exit code. With FLEXARM_TRACEBACK=1 errors show their traceback."""
        for name in ("stdout", "stderr"):
            if getattr(sys, name) is None:  # closed by the shell; a file that is opened now takes its number
                setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_WRONLY), "w", encoding="utf-8"))
            if hasattr(getattr(sys, name), "reconfigure"):
                getattr(sys, name).reconfigure(errors="replace")
        if os.environ.get("FLEXARM_TRACEBACK"):
            return main(arguments) or DONE
        came: list[int] = []
        try:
            with _stops(came):
                refuse_empty(arguments)
                code = main(arguments) or DONE
                sys.stdout.flush()
                return code
        except BaseException as error:
            if came or isinstance(error, KeyboardInterrupt):
                if not self.name:
                    print(file=sys.stderr)  # ends a line that showed the progress
                return self.complain(self.stopped, TERMINATED if came[:1] == [signal.SIGTERM] else STOPPED)
            _empty_stdout()
            if isinstance(error, SystemExit):
                raise
            return self._failed(error)

    def complain(self, line: str, code: int = BAD_INPUT) -> int:
        """Write one line on stderr; return the exit code."""
        text = " ".join("".join(c if c.isprintable() else " " for c in line).split())
        text = text if len(text) <= LONGEST_LINE else f"{text[: LONGEST_LINE - 3]}..."
        print(f"{self.name}: {text}" if self.name else text, file=sys.stderr)
        return code

    def _failed(self, error: BaseException) -> int:
        if isinstance(error, InputError):
            return self.complain(str(error))
        if isinstance(error, BrokenPipeError):
            return DONE
        if isinstance(error, OSError):
            place = f"{error.filename}: " if error.filename else ""
            return self.complain(f"{place}{error.strerror or error}; check the path, its permissions and the disk")
        what = f"{type(error).__name__}: {error}"
        return self.complain(f"a fault of the program, not of your input: {what}; FLEXARM_TRACEBACK=1 shows where")


def end_at_once(stopped: str = Program.stopped) -> None:
    """End by one line on Ctrl-C from now on, until a program runs: while its modules are imported there is nothing to clean up.

    Args:
        stopped: that line.
    """

    def end(number: int, frame: FrameType | None) -> None:
        Program().complain(stopped, STOPPED)
        os._exit(STOPPED)

    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, end)


def refuse_empty(arguments: Sequence[str]) -> None:
    """Refuse arguments without a character, as a shell makes them of a variable that is not set: a path would be this folder.

    Raises:
        InputError: for such an argument.
    """
    for place, argument in enumerate(arguments):
        named = _WITHOUT_VALUE.fullmatch(argument)
        if named is None and argument.strip():
            continue
        before = named[1] if named else next(iter(arguments[place - 1 : place]), "")
        where = f"the value of {before}" if before.startswith("--") else f"argument {place + 1}"
        raise InputError(f"{where} is empty; write one, or leave it out (is a variable of the shell not set?)")


def _empty_stdout() -> None:
    """Write what stdout still holds, and discard what cannot be written."""
    try:
        sys.stdout.flush()
    except OSError:
        discard_stdout()


def discard_stdout() -> None:
    """Discard all output from now on, where nobody reads it: Python would complain, or wait, when it shuts down."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


@contextmanager
def _stops(came: list[int]) -> Iterator[None]:
    """Note every Ctrl-C and termination, and end the block by `Stop`, through its cleanup.

    A termination's own end would leave shared memory behind. Compiled code may swallow the exception or turn it into another one:
    what came tells. What a second termination interrupted would be the cleanup of the first.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        came.append(number)
        if number == signal.SIGINT or len(came) == 1:
            raise Stop

    def unless_stopped(report: Callable[[Any], Any]) -> Callable[[Any], None]:
        return lambda error: None if came else report(error)

    with ExitStack() as restored:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                if signal.getsignal(number) not in (signal.SIG_IGN, None):
                    restored.callback(signal.signal, number, signal.signal(number, stop))
        # Errors of callbacks and of threads that the stop has broken off are reported through these.
        for module, hook in ((sys, "unraisablehook"), (threading, "excepthook")):
            restored.callback(setattr, module, hook, getattr(module, hook))
            setattr(module, hook, unless_stopped(getattr(module, hook)))
        yield
