"""The plant: an arm's structure and active laws, compiled, with its state."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any, Self

import numpy as np

from flexarm_env.plant import layout as at
from flexarm_env.plant.active_laws import ActiveLaw
from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.compose import Law, compose
from flexarm_env.plant.flat_arrays import RESPONSE, Packed, pack
from flexarm_env.plant.structure import LinearModel, Structure, arm_of, stacked

NO_GAINS = np.zeros((0, 0, 0))
NO_INTERVALS = np.zeros(0)
NOT_MEASURED = np.zeros((0, 0))


class Plant:
    """A compiled arm with one state: place it, replay commands, read its physical state.

    Args:
        structure: the linear part.
        active: the active laws.
        catalogue: all laws of the catalogue, with which the kernel is compiled.
        interval: sampling time [s].
    """

    def __init__(self, structure: Structure, active: Sequence[ActiveLaw], catalogue: Sequence[Law], interval: float) -> None:
        model = assemble(structure)
        self._compile(structure, model, catalogue, pack(structure, model, [active], interval), interval)

    @classmethod
    def of_one_kind(
        cls, structures: Sequence[Structure], laws: Sequence[Sequence[ActiveLaw]], catalogue: Sequence[Law], interval: float
    ) -> list[Self]:
        """Compile arms that differ in their numbers only, in one pass; each as it would be alone.

        Args:
            structures: the linear part of each.
            laws: those that act on each.
            catalogue: all laws of the catalogue.
            interval: sampling time [s].

        Raises:
            ValueError: for arms of more kinds than one.
        """
        if len({tuple((law.kind, law.reads) for law in own) for own in laws}) > 1 or structures[0].vibrations:
            raise ValueError("arms of more kinds than one: build a plant of each")
        structure = stacked(structures)
        model = assemble(structure)
        constants, layout, delay = pack(structure, model, laws, interval)
        plants = []
        for arm, own in enumerate(structures):
            plant = cls.__new__(cls)
            plant._compile(own, arm_of(model, arm), catalogue, (constants[arm].copy(), layout, delay), interval)
            plants.append(plant)
        return plants

    def _compile(
        self, structure: Structure, model: LinearModel, catalogue: Sequence[Law], packed: Packed, interval: float
    ) -> None:
        self.kernel: Any = compose(catalogue)
        self.structure, self.model, self.interval = structure, model, interval
        self.signals = model.signals
        self.constants, self.layout, self.delay_samples = packed
        n, d = self.layout, self.constants
        self.blocks, self.states = int(n[at.BLOCKS]), int(n[at.STATES])
        self.bodies = int(n[at.BODIES])
        self.modes = int((n[at.PARAMETERS] - n[at.MODES]) // n[at.STRIDE])
        self.kernel.prepare(d, n)
        self.scratch = np.zeros(self.kernel.scratch_size(n))
        self.state = np.zeros(at.Z_START + 2 * self.blocks)

    def with_own_state(self) -> Self:
        """Make the same plant with a state of its own, for a replay at the same time."""
        other = copy.copy(self)
        other.scratch, other.state = np.zeros_like(self.scratch), self.state.copy()
        return other

    def constants_of(self, structures: Sequence[Structure], laws: Sequence[Sequence[ActiveLaw]]) -> Matrix:
        """Compute the constants (arms, numbers) of arms that differ from this one in their numbers only.

        Args:
            structures: the linear part of each.
            laws: those that act on each.

        Raises:
            ValueError: for arms of another kind.
        """
        structure = stacked(structures)
        constants, layout, delay = pack(structure, assemble(structure), laws, self.interval)
        if not np.array_equal(layout, self.layout) or delay != self.delay_samples:
            raise ValueError("arms of another kind than this plant: build a plant of their own")
        for row in constants:
            self.kernel.prepare(row, layout)
        return constants

    def mode_matrix(self, mode: int, quantity: int, rows: int) -> Matrix:
        """A view of one of the layout's row matrices (rows, 2 blocks) of a mode."""
        start = self.layout[at.MODES] + mode * self.layout[at.STRIDE] + self.layout[quantity]
        return self.constants[start : start + rows * 2 * self.blocks].reshape(rows, 2 * self.blocks)

    def to_modal(self, mode: int) -> Matrix:
        """Look up the matrix (2 blocks, states) that gives a mode's block coordinates from the physical state."""
        start = self.layout[at.MODES] + mode * self.layout[at.STRIDE] + self.layout[at.MODAL]
        return self.constants[start : start + 2 * self.blocks * self.states].reshape(2 * self.blocks, self.states)

    def transition(self, mode: int, interval: float) -> tuple[Matrix, Matrix]:
        """Compute the transition matrix of the physical state over an interval [s] in a mode.

        Returns:
            (states, states); (states,), the change by 1 Nm on the hub.
        """
        start = self.layout[at.MODES] + mode * self.layout[at.STRIDE]
        table = np.zeros((RESPONSE, self.blocks))
        c0_at, c1_at = (int(start + self.layout[key]) for key in (at.C0, at.C1))
        self.kernel.respond(self.constants, c0_at, c1_at, self.blocks, interval, table.reshape(-1), 0)
        c0, c1 = (self.constants[place : place + self.blocks] for place in (c0_at, c1_at))
        c, s, r0 = table[:3]
        step = np.zeros((2 * self.blocks, 2 * self.blocks))
        answer = np.zeros_like(step)
        p = np.arange(0, 2 * self.blocks, 2)
        step[p, p], step[p, p + 1], step[p + 1, p], step[p + 1, p + 1] = c, s, -c0 * s, c - c1 * s
        answer[p, p], answer[p, p + 1], answer[p + 1, p], answer[p + 1, p + 1] = s + c1 * r0, r0, -c0 * r0, s
        to_physical = self.mode_matrix(mode, at.PHYSICAL, self.states)
        hub = self.mode_matrix(mode, at.FORCE_COLUMNS, 1)[0]
        return to_physical @ step @ self.to_modal(mode), to_physical @ answer @ hub

    def place(self, physical: Matrix | None = None, command: float = 0.0, time: float = 0.0) -> None:
        """Set the state [q, q̇, extra] (states,), at rest at angle 0 by default, under a command [A or V] at a time [s]."""
        start = np.zeros(self.states) if physical is None else np.ascontiguousarray(physical, dtype=float)
        self.state[:] = 0.0
        self.state[at.COMMAND] = self.state[at.EARLIER] = command
        self.state[at.TIME] = time
        self.kernel.place_at(self.constants, self.layout, self.state, start, command, self.scratch)

    def physical(self) -> Matrix:
        """Compute [q, q̇, extra] (states,): angles [rad], deflections [m], their rates, lagged current and filters."""
        out = np.zeros(self.states)
        self.kernel.to_physical(self.constants, self.layout, self.state, int(self.state[at.MODE]), out, 0)
        return out

    def replay(
        self,
        commands: Matrix,
        intervals: Matrix = NO_INTERVALS,
        gains: Matrix = NO_GAINS,
        measured: Matrix = NOT_MEASURED,
    ) -> Matrix:
        """Apply commands (samples,) from the present state; return readings (samples, signals) without noise.

        Args:
            commands: held from each sample to the next [A or V].
            intervals: times from sample to sample [s] where sampling is uneven.
            gains: (modes, 2 blocks + bodies, signals), feed the error against `measured` back.
            measured: (samples, signals), needed with gains; NaN where nothing was measured, which corrects nothing.
        """
        return self.play(self.delayed(commands), intervals, gains, measured)

    def play(self, commands: Matrix, intervals: Matrix, gains: Matrix, measured: Matrix) -> Matrix:
        """Apply commands as replay does, already shifted by the whole samples of the delay."""
        readings = np.empty((len(commands), len(self.signals)))
        self.kernel.replay(
            self.constants,
            self.layout,
            self.state,
            commands,
            np.ascontiguousarray(intervals, dtype=float),
            readings.reshape(-1),
            np.ascontiguousarray(gains.swapaxes(1, 2), dtype=float),
            np.ascontiguousarray(measured, dtype=float),
            self.scratch,
        )
        return readings

    def delayed(self, commands: Matrix) -> Matrix:
        """Shift commands (samples,) by the whole samples of the delay; the rest of it is in the plant."""
        shift = self.delay_samples
        if shift == 0:
            return commands
        moved = np.roll(commands, shift)
        if shift > 0:
            moved[:shift] = self.state[at.COMMAND]
        else:
            moved[shift:] = commands[-1]
        return moved
