"""The one exception that bad input raises, and the hint that goes with a misspelt word."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class InputError(ValueError):
    """Bad input from a person: one line that says what came, what is allowed and what to do."""


def did_you_mean(word: str, allowed: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for the nearest allowed word, else the list of those allowed.

    Args:
        word: what came.
        allowed: the words that exist.
    """
    options = sorted(set(allowed))
    near = difflib.get_close_matches(word, options, n=1, cutoff=0.6)
    if near:
        return f"; did you mean '{near[0]}'?"
    return f"; allowed: {', '.join(options)}"
