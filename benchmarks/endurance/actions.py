"""Random actions with extremes: noise, ends of the range in turn or held, anything held, nothing, far too much."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.env.layout import LARGEST_ACTION

Floats = NDArray[np.float32]

#: Calls for which an arm keeps a kind of action: a second of control.
KEPT = 200
#: Kinds of actions, see `block`.
KINDS = 7


def actions(draw: np.random.Generator, calls: int, shape: Sequence[int]) -> Iterator[Floats]:
    """Draw the actions of calls, each of a shape (arms, numbers)."""
    for first in range(0, calls, KEPT):
        yield from block(draw, shape)[: calls - first]


def block(draw: np.random.Generator, shape: Sequence[int]) -> Floats:
    """Draw actions (calls, arms, numbers), of one kind for each number of each arm."""
    noise = draw.uniform(-1.0, 1.0, (KEPT, *shape))
    ends = np.where(noise < 0.0, -1.0, 1.0)
    turns = np.where(np.arange(KEPT) % 2, -1.0, 1.0).reshape(-1, *(1 for _ in shape))
    every = np.ones_like(noise)
    kinds = [noise, ends, turns * every, ends[0] * every, noise[0] * every, 0.0 * every, LARGEST_ACTION * noise]
    chosen: Floats = np.choose(draw.integers(KINDS, size=shape), kinds).astype(np.float32)
    return chosen
