"""The command `flexarm`: exit code 0 done, 1 done and the answer is no, 2 bad input with one clear line."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.terminal.program import DONE, STOPPED, Program


def main() -> None:
    """Run the command line and leave with its exit code."""
    sys.exit(_flexarm())


def run(arguments: Sequence[str]) -> int:
    """Run a command line; return its exit code. With FLEXARM_TRACEBACK=1 errors show their traceback."""
    return _flexarm(arguments)


@Program("flexarm")
def _flexarm(arguments: Sequence[str]) -> int:
    with warnings.catch_warnings():
        if not sys.warnoptions:
            warnings.simplefilter("ignore")
        try:
            return _call(arguments)
        except Exception as error:
            if type(error).__name__ == "NoArgsIsHelpError":
                return DONE  # the help stands on stdout
            if type(error).__name__ == "Abort":
                raise KeyboardInterrupt from None
            if hasattr(error, "format_message"):
                raise InputError(_usage(error)) from None
            raise


def _call(arguments: Sequence[str]) -> int:
    from flexarm_env.cli.app import app

    code = app(args=list(arguments), prog_name="flexarm", standalone_mode=False)
    if code == STOPPED:  # Typer caught Ctrl-C and printed nothing
        raise KeyboardInterrupt
    return code if isinstance(code, int) else DONE


def _usage(error: Exception) -> str:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "flexarm"
    option = getattr(error, "option_name", None)
    commands = getattr(getattr(context, "command", None), "commands", None)
    message = _with_value(error, error.format_message())  # type: ignore[attr-defined]
    if type(error).__name__ == "NoSuchOption" and option and context is not None:
        allowed = [name for p in context.command.get_params(context) for name in p.opts if name.startswith("--")]
        message = f"unknown option '{option}'{did_you_mean(option, allowed)}"
    elif message.startswith("No such command") and commands:
        word = message.split("'")[1]
        message = f"unknown command '{word}'{did_you_mean(word, commands)}"
    line = " ".join(message.split()).rstrip(".")
    return f"{line[0].lower()}{line[1:]} (see {command} --help)"


def _with_value(error: Exception, message: str) -> str:
    """Add the value that came to a message of Typer that names only what is allowed, as since it takes values by pydantic."""
    faults = getattr(error.__cause__, "errors", None)
    if faults is None:
        return message
    from flexarm_env.recordings.messages import quoted

    where, _, allowed = message.partition(", unable to parse string")[0].partition(": ")
    return f"{where}: {quoted(str(faults()[0]['input']))}; {allowed[:1].lower()}{allowed[1:]}"
