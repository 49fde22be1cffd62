"""The exceptions for bad input, and the hint for a misspelt word."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def printable(text: str) -> str:
    r"""Escape the characters that would break a line of text or vanish in it.

    Examples:
        >>> printable("gain\x7f\n")
        'gain\\x7f\\n'
    """
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


class InputError(ValueError):
    """Bad input from a user, in one line: the input, the allowed values, and the remedy.

    Whatever the text quotes from a file or a command line is escaped.
    """

    def __init__(self, text: object = "") -> None:
        super().__init__(printable(str(text)))


class UnknownArgument(InputError, TypeError):
    """A keyword argument that a function does not have: also the TypeError with which Python itself refuses one."""


def did_you_mean(word: str, allowed: Iterable[str]) -> str:
    """Suggest the nearest allowed word, "; did you mean 'x'?", or list those allowed; say nothing where none is.

    Args:
        word: as given.
        allowed: the valid words.
    """
    options = sorted(set(allowed))
    near = difflib.get_close_matches(word, options, n=1, cutoff=0.6)
    if near:
        return f"; did you mean '{near[0]}'?"
    return f"; allowed: {', '.join(options)}" if options else ""
