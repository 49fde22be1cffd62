"""Motion of a plant in closed loop: the control law computes each command from the model's own readings."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.replay.loop import Loop
from flexarm_env.plant import layout as at
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class LoopReplay:
    """A replay in closed loop.

    Attributes:
        readings: (samples, signals), SI units; NaN from where the state is lost.
        command: (samples,) [A or V].
    """

    readings: Floats
    command: Floats


def play_loop(plant: Plant, loop: Loop, intervals: Floats) -> LoopReplay:
    """Move a plant from its present state under a control law, over the samples of its reference.

    The law reads the model's readings without noise and without the sensors' steps. Both belong to the scale of the errors
    already, and nobody knows the draw that the recorded command contains: in a linear law its share averages to nothing, while
    another draw would count as an error of the model.

    Args:
        plant: a compiled arm.
        loop: law and reference.
        intervals: (samples,) times between samples [s] where they are uneven, else empty.
    """
    count = len(loop.reference)
    readings = np.full((count, len(plant.signals)), np.nan)
    plant.kernel.measure(plant.constants, plant.layout, plant.state, readings.reshape(-1), 0)
    before = float(plant.state[at.COMMAND])
    hub_speed = float(plant.physical()[len(plant.model.names)])
    interval = float(np.median(intervals)) if len(intervals) else plant.interval
    running = loop.start_law(readings[0], hub_speed, interval, before)
    # Where readings are ahead of commands, the law has the reference of a later row by then.
    ahead = max(-plant.delay_samples, 0)
    reference = np.pad(loop.reference, (0, ahead), mode="edge")[ahead:].tolist()
    waiting = deque([before] * max(plant.delay_samples, 0))
    commands, pair = np.full(count, np.nan), np.zeros(2)
    for k in range(count):
        row = readings[k].tolist()
        commands[k] = running.command([row[column] for column in loop.columns], reference[k])
        waiting.append(commands[k])
        pair[:] = waiting.popleft()
        if k + 1 == count or not np.isfinite(commands[k]):
            break
        readings[k + 1] = plant.play(pair, intervals[k : k + 2], NO_GAINS, NOT_MEASURED)[1]
    return LoopReplay(readings, np.pad(commands, (ahead, 0), constant_values=before)[:count])
