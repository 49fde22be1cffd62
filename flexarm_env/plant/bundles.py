"""Arrays and numbers that kernels hand on together.

numba passes a named tuple as it would its fields, so a bundle costs nothing. A bundle holds no other arrays than the
functions that take it need: each that a call hands over takes seven numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]  # (any,), contiguous, as are the others
Samples = NDArray[np.float64]  # (samples, signals)
Gains = NDArray[np.float64]  # (modes, signals, 2 blocks + bodies)
Places = NDArray[np.int64]  # (any,)


class Arrays(NamedTuple):
    """The arrays of an arm (see layout.py): constants, places, state, scratch."""

    d: Numbers
    n: Places
    s: Numbers
    w: Numbers


class Segment(NamedTuple):
    """Part of an array, from a place on."""

    data: Numbers
    first: int


class Blocks(NamedTuple):
    """Blocks of a mode: places of their c₀ and c₁ in d, their number, and whether the force on them varies in time."""

    c0: int
    c1: int
    number: int
    varying: int


class Motion(NamedTuple):
    """Exact motion of the blocks over a step: arrays, and places in w.

    `force` holds the force's coefficients, `trial` the state at the end, `sizes` the blocks' amplitudes, `copy` a copy of
    the motion that is brought to any time within the step.
    """

    d: Numbers
    s: Numbers
    w: Numbers
    blocks: Blocks
    force: int
    trial: int
    sizes: int
    copy: int


class Line(NamedTuple):
    """A quantity sign · (row · z) + o₀ + o₁ t + o₂ t²/2, with the places in d of its row and of the row's weights."""

    row: int
    weight: int
    sign: float
    o0: float
    o1: float
    o2: float


class Point(NamedTuple):
    """Value and rate of a quantity at a time."""

    t: float
    value: float
    rate: float


class SubstepScratch(NamedTuple):
    """Places in w during a substep.

    The state at the end, the force on the blocks, the laws' coefficients of 1, t, t²/2; their values at the nodes of the
    fit, the motion that they take; amplitudes, the copy of the motion, the state at an event; own tables of responses and of
    the forces' influence; the physical state.
    """

    trial: int
    force: int
    coefficients: int
    nodes: int
    motion: int
    sizes: int
    copy: int
    found: int
    responses: int
    influence: int
    physical: int
