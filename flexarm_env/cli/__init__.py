"""The command `flexarm`: exit code 0 done, 1 done and the answer is no, 2 bad input with one clear line."""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections.abc import Sequence
from typing import Any

#: As shells count: 128 and the number of the signal.
DONE, NO, BAD_INPUT, STOPPED, TERMINATED = 0, 1, 2, 130, 143


def main() -> None:
    """Run the command line and leave with its exit code."""
    signal.signal(signal.SIGTERM, _terminate)
    sys.exit(run(sys.argv[1:]))


def _terminate(number: int, frame: Any) -> None:
    """Leave through every cleanup, as Ctrl-C does: a signal's own end would leave shared memory behind."""
    raise SystemExit(TERMINATED)


def run(arguments: Sequence[str]) -> int:
    """Run a command line; return its exit code. With FLEXARM_TRACEBACK=1 errors show their traceback."""
    from flexarm_env.errors import InputError

    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    if os.environ.get("FLEXARM_TRACEBACK"):
        return _call(arguments)
    try:
        with warnings.catch_warnings():
            if not sys.warnoptions:
                warnings.simplefilter("ignore")
            return _call(arguments)
    except InputError as error:
        return complain(str(error))
    except BrokenPipeError:
        from flexarm_env.terminal.outputs import discard_stdout

        discard_stdout()
        return DONE
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        return complain(f"{place}{error.strerror or error}; check the path, its permissions and the disk")
    except KeyboardInterrupt:
        return complain("stopped", STOPPED)
    except SystemExit as end:
        if end.code != TERMINATED:
            raise
        return complain("stopped", TERMINATED)
    except Exception as error:
        return _other(error)


def _call(arguments: Sequence[str]) -> int:
    from flexarm_env.cli.app import app

    code = app(args=list(arguments), prog_name="flexarm", standalone_mode=False)
    if code == STOPPED:  # Typer caught Ctrl-C and printed nothing
        return complain("stopped", STOPPED)
    return code if isinstance(code, int) else DONE


def _other(error: Exception) -> int:
    """Report a usage error, an interruption that Typer caught, or a fault of the program itself."""
    if type(error).__name__ == "Abort":
        return complain("stopped", STOPPED)
    if type(error).__name__ == "NoArgsIsHelpError":
        return DONE  # the help stands on stdout
    if hasattr(error, "format_message"):
        return complain(_usage(error))
    what = f"{type(error).__name__}: {error}"
    return complain(f"a fault of the program, not of your input: {what}; FLEXARM_TRACEBACK=1 shows where")


def _usage(error: Exception) -> str:
    from flexarm_env.errors import did_you_mean

    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "flexarm"
    option = getattr(error, "option_name", None)
    commands = getattr(getattr(context, "command", None), "commands", None)
    message = error.format_message()  # type: ignore[attr-defined]
    if type(error).__name__ == "NoSuchOption" and option and context is not None:
        allowed = [name for p in context.command.get_params(context) for name in p.opts if name.startswith("--")]
        message = f"unknown option '{option}'{did_you_mean(option, allowed)}"
    elif message.startswith("No such command") and commands:
        word = message.split("'")[1]
        message = f"unknown command '{word}'{did_you_mean(word, commands)}"
    line = " ".join(message.split()).rstrip(".")
    return f"{line[0].lower()}{line[1:]} (see {command} --help)"


def complain(line: str, code: int = BAD_INPUT) -> int:
    """Write one line on stderr; return the exit code."""
    text = "".join(c if c.isprintable() else " " for c in line)
    print(f"flexarm: {' '.join(text.split())}", file=sys.stderr)
    return code
