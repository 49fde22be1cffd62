"""Modes of the plant: which bodies are held, and whether the gears are open."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Places

#: Bit of a mode with open gears, the highest one.
GEAR_OPEN = 4


@njit
def record(n: Places, mode: int) -> int:
    """Locate a mode's record in d."""
    return n[at.MODES] + mode * n[at.STRIDE]


@njit
def is_stuck(mode: int, body: int) -> bool:
    """Whether the mode holds the body (0 hub, 1 motor)."""
    return (mode >> body) & 1 == 1
