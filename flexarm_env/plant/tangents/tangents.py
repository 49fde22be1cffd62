"""Readings with their derivatives, of a plant."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.plant import layout as at
from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.plant import NO_GAINS, NO_INTERVALS, NOT_MEASURED, Plant
from flexarm_env.plant.tangents.compose import tangent_kernel

#: Difference of a constant on which an effect's law depends, over its size.
LAW_STEP = 1e-6
#: Lanes are filled up to a multiple of this, which the compiled loops take at once.
FULL = 16


class Tangents:
    """Derivatives of a plant's readings with respect to constants of the arm.

    Args:
        plant: the compiled arm.
        constants: derivatives (numbers, constants) of the plant's own (see constant_tangents).
        scales: (constants,) sizes of the constants, each in its unit, for differences of effects' laws.
    """

    def __init__(self, plant: Plant, constants: Matrix, scales: Matrix) -> None:
        self.plant, self.count = plant, len(scales)
        spare = -self.count % FULL
        self.constants = np.pad(constants, ((0, 0), (0, spare)))
        self.law_steps = np.pad(np.where(self._in_laws(constants), LAW_STEP * scales, 0.0), (0, spare))
        self.kernel: Any = tangent_kernel(plant.kernel)
        self.rows = int(self.kernel.tangent_rows(plant.constants, plant.layout))
        self.numbers = int(self.kernel.tangent_numbers(plant.constants, plant.layout))

    def replay(
        self, commands: Matrix, intervals: Matrix = NO_INTERVALS, gains: Matrix = NO_GAINS, measured: Matrix = NOT_MEASURED
    ) -> tuple[Matrix, Matrix]:
        """Apply commands from the plant's present state as `Plant.replay` does.

        The physical state at the start, the measured values and the physical gains do not depend on the constants.

        Returns:
            Readings (samples, signals), the same to the last bit; their derivatives (samples, signals, constants).
        """
        plant, kernel, lanes = self.plant, self.kernel, self.constants.shape[1]
        readings = np.empty((len(commands), len(plant.signals)))
        derivatives = np.empty((readings.size, lanes))
        arrays = kernel.Arrays(plant.constants.copy(), plant.layout, plant.state, plant.scratch)
        steady = np.zeros((int(kernel.steady_rows(plant.layout)), lanes))
        tangent = kernel.Tangent(self.constants, self._start(), np.zeros((self.rows, lanes)), np.zeros(self.numbers), steady)
        given = (plant.delayed(commands), intervals, gains.swapaxes(1, 2), measured)
        floats = [np.ascontiguousarray(numbers, dtype=float) for numbers in given]
        run = kernel.Run(*floats, readings.reshape(-1), self._gains(gains), self.law_steps, derivatives)
        kernel.replay_with_lanes(arrays, tangent, run)
        return readings, derivatives.reshape(*readings.shape, lanes)[..., : self.count]

    def _in_laws(self, constants: Matrix) -> NDArray[np.bool_]:
        """Tell on which constants (constants,) the laws depend themselves: by their parameters, or by the load of the gears."""
        n = self.plant.layout
        rows = [constants[n[at.PARAMETERS] :]]
        if n[at.VARYING]:
            rows.append(constants[[at.GAP, *range(at.LOAD_STIFFNESS, at.BACK_EMF + 1)]])
        return np.any(np.concatenate(rows) != 0.0, axis=0)

    def _modal(self, mode: int) -> Matrix:
        """Derivatives (2 blocks, states, constants) of the matrix that gives block coordinates from the physical state."""
        plant = self.plant
        n, size = plant.layout, 2 * plant.blocks
        start = n[at.MODES] + mode * n[at.STRIDE] + n[at.MODAL]
        return self.constants[start : start + size * plant.states].reshape(size, plant.states, -1)

    def _start(self) -> Matrix:
        """Derivatives (numbers, constants) of the state at the start, whose physical one is constant."""
        start = np.zeros((len(self.plant.state), self.constants.shape[1]))
        start[at.Z_START :] = np.einsum("isc,s->ic", self._modal(int(self.plant.state[at.MODE])), self.plant.physical())
        return start

    def _gains(self, gains: Matrix) -> Matrix:
        """Derivatives (modes · 2 blocks · signals, constants) of the blocks' gains, whose physical ones are constant."""
        plant, size = self.plant, 2 * self.plant.blocks
        if not len(gains):
            return np.zeros((0, self.constants.shape[1]))
        found = []
        for mode in range(plant.modes):
            physical = plant.mode_matrix(mode, at.PHYSICAL, plant.states) @ gains[mode, :size]
            found.append(np.einsum("isc,sj->ijc", self._modal(mode), physical))
        return np.ascontiguousarray(np.array(found).reshape(-1, self.constants.shape[1]))
