"""The vibrations of a beam that replays keep: fast ones that no reading shows make steps and events as dear as slow ones do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import plants_by_stated
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.thinning import with_friction
from flexarm_env.identify.settings import Settings
from flexarm_env.plant import layout as at
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant
from flexarm_env.plant.reduction import beam_coordinates, reduce_state

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Window:
    """A part of a run that a whole arm has played.

    Attributes:
        run: to which it belongs.
        part: its samples.
        commands: (samples,) [A or V].
        state: physical state at its start (states,).
        before: the command until then.
        readings: (samples, signals), SI units.
    """

    run: Run
    part: slice
    commands: Floats
    state: Floats
    before: float
    readings: Floats

    def change(self, reduced: Plant, state: Floats) -> Floats:
        """Compute the change of the readings (samples, signals) by a plant, from a state of its own."""
        reduced.place(state, self.before, float(self.run.time[self.part][0]))
        return reduced.play(self.commands, self.run.intervals[self.part], NO_GAINS, NOT_MEASURED) - self.readings


def count_vibrations(arm: Arm, runs: Sequence[Run], interval: float, noise: Floats, settings: Settings) -> int:
    """Count the slowest vibrations of the beam without the rest of which no signal changes by more than a share of its noise.

    Args:
        arm: the model. Where it lacks Coulomb friction, it is given some: a hub that stops excites fast vibrations.
        runs: the recordings.
        interval: sampling time [s].
        noise: (signals,) standard deviation of the readings.
        settings: numbers of the method.

    Returns:
        The number; 0 where all are needed.
    """
    if not arm.structure().elements:
        return 0
    arm = with_friction(arm, [run.command for run in runs], settings)
    stated, length = [run.stated for run in runs], max(round(settings.preparation.window / interval), 1)
    plants = plants_by_stated(arm, stated, interval)
    most = -(-settings.thinning.vibration_windows // len(runs))
    windows = [window for run in runs for window in _played(plants[run.stated], run, length, most)]
    model = plants[stated[0]].model
    for count in range(1, len(model.names) - beam_coordinates(model).start):
        reduced = plants_by_stated(arm, stated, interval, count)
        changes = [
            window.change(reduced[window.run.stated], reduce_state(plants[window.run.stated].model, window.state, count))
            for window in windows
        ]
        if np.sqrt(np.mean((np.concatenate(changes) / noise) ** 2, axis=0).max()) <= settings.thinning.vibration_error:
            return count
    return 0


def _played(plant: Plant, run: Run, length: int, most: int) -> list[Window]:
    """Play a run from rest; give some windows of so many samples, spread over it."""
    plant.place()
    commands, firsts = plant.delayed(run.command), range(0, len(run.command), length)
    kept = set(np.linspace(0, len(firsts) - 1, min(most, len(firsts))).astype(int))
    found = []
    for place, first in enumerate(firsts):
        part, state, before = slice(first, first + length), plant.physical(), float(plant.state[at.COMMAND])
        readings = plant.play(commands[part], run.intervals[part], NO_GAINS, NOT_MEASURED)
        if place in kept:
            found.append(Window(run, part, commands[part], state, before, readings))
    return found
