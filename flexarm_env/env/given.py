"""Numbers that are given to an environment: what is taken as one, and what only looks like it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError


def one_number(name: str, given: Any, remedy: str) -> float:
    """Convert a real number of Python or numpy.

    Args:
        name: of the number, for the message.
        given: to be converted.
        remedy: end of the message, such as "give a number [s]".

    Raises:
        InputError: for a text, a truth value, a complex number, or one beyond any float.
    """
    if isinstance(given, bool) or not isinstance(given, int | float | np.integer | np.floating):
        raise InputError(f"{name} = {given!r}; {remedy}")
    try:
        return float(given)
    except OverflowError:
        raise InputError(f"{name} is beyond any float; {remedy}") from None


def two_numbers(name: str, given: Any, remedy: str) -> tuple[float, float]:
    """Convert a list, tuple or array of a lowest and a highest number.

    Args:
        name: of the pair, for the message.
        given: to be converted.
        remedy: end of the message.

    Raises:
        InputError: for anything else, such as a text of two digits, or a table with two keys.
    """
    if not is_list(given) or len(given) != 2:
        raise InputError(f"{name} = {given!r}; {remedy}")
    low, high = (one_number(name, value, remedy) for value in given)
    return low, high


def is_list(given: Any) -> bool:
    """Whether something is a list, a tuple or an array of any axes, and no text."""
    if isinstance(given, np.ndarray):
        return given.ndim > 0
    return isinstance(given, Sequence) and not isinstance(given, str | bytes | bytearray)


def real_array(given: Any) -> NDArray[Any] | None:
    """Convert numbers in any nesting to an array; None for texts, and for what is ragged, complex or partly masked."""
    if type(given) is np.ndarray and given.dtype.kind == "f":
        return given
    try:
        found = np.asarray(given)
    except (TypeError, ValueError):  # ragged lists
        return None
    return found if found.dtype.kind in "biuf" and not np.ma.is_masked(given) else None
