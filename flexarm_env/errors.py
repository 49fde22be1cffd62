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


#: Characters; a longer word misspells none, and comparing it would take its length in memory and time.
_LONGEST_WORD = 100


class InputError(ValueError):
    """Bad input from a user, in one line: the input, the allowed values, and the remedy.

    Whatever the text quotes from a file or a command line is escaped.
    """

    def __init__(self, text: object = "") -> None:
        super().__init__(printable(str(text)))


class UnknownArgument(InputError, TypeError):
    """A keyword argument that a function does not have: also the TypeError with which Python itself refuses one."""


def nearest(word: str, allowed: Iterable[str], cutoff: float = 0.6) -> str | None:
    """Find the allowed word that a word misspells; None where it is like none.

    Args:
        word: as given.
        allowed: the valid words.
        cutoff: least likeness, from 0 to 1 for the word itself.

    Examples:
        >>> nearest("paylod", ["payload", "start"])
        'payload'
    """
    if len(word) > _LONGEST_WORD:
        return None
    return next(iter(difflib.get_close_matches(word, sorted(set(allowed)), n=1, cutoff=cutoff)), None)


def did_you_mean(word: str, allowed: Iterable[str]) -> str:
    """Suggest the nearest allowed word, "; did you mean 'x'?", or list those allowed; say nothing where none is.

    Args:
        word: as given.
        allowed: the valid words.
    """
    options = sorted(set(allowed))
    near = nearest(word, options)
    if near is not None:
        return f"; did you mean '{near}'?"
    return f"; allowed: {', '.join(options)}" if options else ""
