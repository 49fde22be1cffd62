"""Starts of episodes that differ from the task's: the options of a reset, and states to go on from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.env.given import real_array
from flexarm_env.env.setup import Setup
from flexarm_env.env.state import State
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.plant.layout import Z_START
from flexarm_env.plant.plant import Plant
from flexarm_env.plant.replay import RUN_AWAY

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Start:
    """Where episodes start, in place of the task's start; None: there.

    Attributes:
        state: of all arms, from which they go on in the middle of their episodes.
        physical: state [q, q̇, extra] of each arm at the start (arms, states).
        targets: of each arm (arms,) [rad].
    """

    state: State | None = None
    physical: Floats | None = None
    targets: Floats | None = None

    def check_seed(self, seed: Any) -> None:
        """Refuse a seed beside a state, which has its own random draws.

        Raises:
            InputError: for both.
        """
        if self.state is not None and seed is not None:
            raise InputError("seed beside a state, which has random draws of its own: leave out seed, or give state.physical")


#: The task's own start.
TASK_START = Start()


def find_start(options: Any, setup: Setup, sizes: tuple[int, int], further: Iterable[str] = ()) -> Start:
    """Read the start of episodes from the options of a reset.

    Args:
        options: "state", "target", both may be left out; or None.
        setup: of the environment.
        sizes: number of arms, and of the quantities of an arm's state.
        further: names of options that are read elsewhere.

    Raises:
        InputError: for an option that does not exist or does not make sense.
    """
    if options is None:
        return TASK_START
    allowed = ("state", "target", *further)
    if not isinstance(options, Mapping):
        raise InputError(f"options = {options!r}; give a dict with any of {', '.join(allowed)}, or None")
    for name in options:
        if name not in allowed:
            raise InputError(f"options: unknown option '{name}'{did_you_mean(str(name), allowed)}")
    state, target, count = options.get("state"), options.get("target"), sizes[0]
    targets = None if target is None else _array("target", target, (count,), "angle [rad]")
    largest = setup.largest()[-1]
    if targets is not None and not np.abs(targets).max() <= largest:
        raise InputError(f"options: target = {target}; give an angle from {-largest:.4g} to {largest:.4g} rad")
    if isinstance(state, State):
        return Start(state, None, targets)
    physical = None if state is None else _array("state", state, sizes, "state, or one of each arm, as env.state().physical")
    return Start(None, physical, targets)


def _array(name: str, given: Any, shape: tuple[int, ...], meaning: str) -> Floats:
    """Make finite numbers of a shape, of which the first axis may be left out."""
    values = real_array(given)
    if values is None:
        raise InputError(f"options: {name} = {given!r}; give one {meaning}, in numbers")
    if not np.isfinite(values).all():
        raise InputError(f"options: {name} = {given!r}; give finite numbers")
    if values.shape not in (shape, shape[1:]):
        raise InputError(f"options: {name} of shape {values.shape}; give one {meaning}, in shape {shape[1:]} or {shape}")
    return np.array(np.broadcast_to(values, shape), dtype=np.float64)


def placed(plant: Plant, physical: Floats) -> Floats:
    """Compute the plant's numbers at a physical state (states,).

    Raises:
        InputError: for a state beyond all reason, in which the arm would be lost.
    """
    within_reason = np.abs(physical).max() < RUN_AWAY  # the modes lack the angle of the whole arm
    if within_reason:
        plant.place(physical)
    if not (within_reason and np.abs(plant.state[Z_START:]).sum() < RUN_AWAY):
        raise InputError(f"options: state = {physical.tolist()}; no arm moves that far or that fast")
    return plant.state.copy()
