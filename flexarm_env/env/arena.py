"""One array that holds all numbers of a batch of arms, with a view of each quantity."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from flexarm_env.env import layout as at
from flexarm_env.env.setup import Setup
from flexarm_env.env.shares import LINE
from flexarm_env.plant import batch as plant_at
from flexarm_env.plant.plant import Plant
from flexarm_env.plant.truth import TRUTH_SIZE

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


class Arena:
    """Arrays of given shapes, one after another in a common one: the kernels pay for each array that they are given.

    Args:
        shapes: of each quantity, by name.

    Attributes:
        numbers: the common array.
        views: of each quantity in it, by name.
        starts: offset of each quantity's first number, by name.
    """

    def __init__(self, shapes: Mapping[str, tuple[int, ...]]) -> None:
        ends = np.cumsum([math.prod(shape) for shape in shapes.values()])
        self.numbers = np.zeros(ends[-1])
        self.starts = dict(zip(shapes, [0, *ends[:-1].tolist()], strict=True))
        self.views = {
            name: self.numbers[self.starts[name] :][: math.prod(shape)].reshape(shape) for name, shape in shapes.items()
        }


def arena_of(setup: Setup, plant: Plant, sensors: Floats, count: int, threads: int) -> Arena:
    """Lay out the numbers of a batch of arms.

    Args:
        setup: of the environment.
        plant: of an arm like all others.
        sensors: their numbers (signals, SENSOR).
        count: of arms.
        threads: that move them on.
    """
    signals, late = len(sensors), sensors[:, at.WHOLE_DELAY :].any()
    depth = int(sensors[:, at.WHOLE_DELAY].max()) + 2 if late else 0
    terms = len(setup.task.terms)
    return Arena(
        {
            "settings": (at.WEIGHTS + terms,),
            "sensors": sensors.shape,
            "outcome": (at.TERMS + terms, count + LINE - count % LINE),  # multiples of 512 would evict each other from the cache
            "own": (count, at.COLUMNS),
            "noiseless": (count, signals + TRUTH_SIZE),
            "requested": (count,),
            "applied": (count,),
            "tap_commands": (count,),
            "sensor_output": (count, signals),
            "history": (count, depth, signals),
            "constants": (count if setup.variation.ranges else 1, plant.constants.size),
            "states": (count, plant.state.size),
            "scratch": (threads, plant.scratch.size),
        }
    )


def env_offsets_of(arena: Arena) -> Indices:
    """Tabulate the environment's offsets in the arena, see layout."""
    views, starts, offsets = arena.views, arena.starts, np.zeros(at.OFFSETS, dtype=np.int64)
    offsets[at.AT_SETTINGS], offsets[at.AT_SENSORS], offsets[at.AT_OWN] = starts["settings"], starts["sensors"], starts["own"]
    offsets[at.AT_NOISELESS], offsets[at.NOISELESS_EACH] = starts["noiseless"], views["noiseless"].shape[1]
    offsets[at.AT_OUTCOME], offsets[at.ROW_EACH] = starts["outcome"], views["outcome"].shape[1]
    offsets[at.AT_REQUESTED], offsets[at.AT_TAP_COMMANDS] = starts["requested"], starts["tap_commands"]
    offsets[at.AT_HISTORY], offsets[at.AT_SENSOR_OUTPUT] = starts["history"], starts["sensor_output"]
    _, offsets[at.DEPTH], offsets[at.SIGNALS] = views["history"].shape
    return offsets


def plant_offsets_of(arena: Arena, delayed: bool) -> Indices:
    """Tabulate the plant's offsets in the arena, see plant.batch.

    Args:
        arena: of the batch.
        delayed: whether commands are applied whole samples after they are requested.
    """
    views, starts, offsets = arena.views, arena.starts, np.zeros(plant_at.SCRATCH_EACH + 1, dtype=np.int64)
    arms, size = views["constants"].shape
    offsets[plant_at.AT_CONSTANTS], offsets[plant_at.CONSTANTS_EACH] = starts["constants"], size if arms > 1 else 0
    offsets[plant_at.AT_STATES], offsets[plant_at.STATE_EACH] = starts["states"], views["states"].shape[1]
    offsets[plant_at.AT_COMMANDS] = starts["applied" if delayed else "requested"]
    offsets[plant_at.AT_TAP_COMMANDS], offsets[plant_at.AT_NOISELESS] = starts["tap_commands"], starts["noiseless"]
    offsets[plant_at.AT_SCRATCH], offsets[plant_at.SCRATCH_EACH] = starts["scratch"], views["scratch"].shape[1]
    return offsets
