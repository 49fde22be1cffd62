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
        starts: place of each quantity's first number, by name.
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
            "exact": (count, signals + TRUTH_SIZE),
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


def places_of(arena: Arena) -> Indices:
    """Tabulate the environment's places in the arena, see layout."""
    views, starts, places = arena.views, arena.starts, np.zeros(at.PLACES, dtype=np.int64)
    places[at.AT_SETTINGS], places[at.AT_SENSORS], places[at.AT_OWN] = starts["settings"], starts["sensors"], starts["own"]
    places[at.AT_EXACT], places[at.EXACT_EACH] = starts["exact"], views["exact"].shape[1]
    places[at.AT_OUTCOME], places[at.ROW_EACH] = starts["outcome"], views["outcome"].shape[1]
    places[at.AT_REQUESTED], places[at.AT_TAP_COMMANDS] = starts["requested"], starts["tap_commands"]
    places[at.AT_HISTORY], places[at.AT_SENSOR_OUTPUT] = starts["history"], starts["sensor_output"]
    _, places[at.DEPTH], places[at.SIGNALS] = views["history"].shape
    return places


def physics_of(arena: Arena, delayed: bool) -> Indices:
    """Tabulate the plant's places in the arena, see plant.batch.

    Args:
        arena: of the batch.
        delayed: whether commands are applied whole samples after they are requested.
    """
    views, starts, places = arena.views, arena.starts, np.zeros(plant_at.SCRATCH_EACH + 1, dtype=np.int64)
    arms, size = views["constants"].shape
    places[plant_at.AT_CONSTANTS], places[plant_at.CONSTANTS_EACH] = starts["constants"], size if arms > 1 else 0
    places[plant_at.AT_STATES], places[plant_at.STATE_EACH] = starts["states"], views["states"].shape[1]
    places[plant_at.AT_COMMANDS] = starts["applied" if delayed else "requested"]
    places[plant_at.AT_TAP_COMMANDS], places[plant_at.AT_LOOKS] = starts["tap_commands"], starts["exact"]
    places[plant_at.AT_SCRATCH], places[plant_at.SCRATCH_EACH] = starts["scratch"], views["scratch"].shape[1]
    return places
