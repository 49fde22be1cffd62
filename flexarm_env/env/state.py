"""The state of an environment as a value: everything on which its next steps depend."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError


@dataclass(frozen=True, eq=False)
class State:
    """Arms in the middle of their episodes: an environment that is set to a state goes on from it bit for bit.

    It can be copied and pickled, and is equal to another one with the same bits.

    Attributes:
        origin: task, arm and a hash of their numbers, which an environment must share to be set to the state.
        physical: [q, q̇, extra] of one arm (states,) or of many (arms, states): angles [rad], deflections [m] and slopes
            [rad] of the beam's nodes, their rates, lagged current and filters.
        numbers: arrays by name: the plants, readings, clocks, targets and random draws.
    """

    origin: str
    physical: NDArray[np.float64]
    numbers: Mapping[str, NDArray[Any]]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, State):
            return NotImplemented
        mine, theirs = self.numbers, other.numbers
        same = self.origin == other.origin and mine.keys() == theirs.keys()
        return same and all(np.array_equal(mine[name], theirs[name], equal_nan=mine[name].dtype.kind == "f") for name in mine)

    __hash__ = None  # type: ignore[assignment]


def check_state(state: Any, origin: str, count: int) -> State:
    """Refuse a state that an environment cannot be set to.

    Args:
        state: to be checked.
        origin: of the environment.
        count: of its arms.

    Raises:
        InputError: naming both environments.
    """
    if not isinstance(state, State):
        raise InputError(f"state of type {type(state).__name__}; give one that env.unwrapped.state() has returned")
    if state.origin != origin:
        raise InputError(f"state of another environment ({state.origin}); this one is ({origin})")
    arms = len(state.numbers["seeds"])
    if arms != count:
        raise InputError(f"state of {arms} arms; this environment has {count}")
    return state
