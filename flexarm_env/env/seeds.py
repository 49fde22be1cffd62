"""Seeds that are given to a reset: whole numbers, each of which has draws of its own."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexarm_env.env.given import is_list
from flexarm_env.errors import InputError

#: Largest seed: the draws are hashes of 64 bits.
LARGEST_SEED = 2**64 - 1


def one_seed(given: Any, name: str = "seed") -> int | None:
    """Check the seed of one arm; None is none.

    Args:
        given: a whole number of Python or numpy, or None.
        name: of it, for the message.

    Raises:
        InputError: for anything but a whole number from 0 to 2⁶⁴ − 1.
    """
    if given is None:
        return None
    if not _is_whole(given) or not 0 <= int(given) <= LARGEST_SEED:
        raise InputError(f"{name} = {given!r}; give a whole number from 0 to 2**64 - 1")
    return int(given)


def seeds_of(given: Any, count: int) -> list[int | None]:
    """List the seeds of many arms: given + i for arm i, or one for each.

    Args:
        given: a whole number, as many of them as arms, each of which may be None, or None.
        count: of the arms.

    Raises:
        InputError: for a seed that is none, or another number of them.
    """
    if given is None or _is_whole(given):
        first = one_seed(given)
        return [None if first is None else one_seed(first + i, f"seed of arm {i}") for i in range(count)]
    if not is_list(given):
        raise InputError(f"seed = {given!r}; give a whole number, or one for each arm")
    if len(given) != count:
        raise InputError(f"{len(given)} seeds for {count} arms; give one for each, or one number")
    return [one_seed(one, f"seed of arm {i}") for i, one in enumerate(given)]


def _is_whole(given: Any) -> bool:
    if isinstance(given, np.ndarray):
        return given.ndim == 0 and given.dtype.kind in "iu"
    return isinstance(given, int | np.integer) and not isinstance(given, bool)
