"""The initial state of a recording: fitted to its first samples with a plant, and carried along as its constants change."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from flexarm_env.identify.replay.closed_loop import play_loop
from flexarm_env.identify.replay.initial_state import Start
from flexarm_env.identify.replay.loop import Loop
from flexarm_env.identify.replay.readings import bounded, count_of, errors_of
from flexarm_env.identify.settings import InitialStates
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class StartFit:
    """An initial state along the directions of a plant, and its step by the errors that it leaves.

    Attributes:
        moves: (directions,) from the state that the samples show without a model; none where nothing is fitted.
        weights: (directions,) one over the expected size of a move.
        level: rms by which errors are divided, at least the noise.
        step: (directions, rows + directions) Gauss–Newton step by the errors and the weighted moves.
        at_rest: whether the hub was at rest after all.
    """

    moves: Floats
    weights: Floats
    level: float = 1.0
    step: Floats | None = None
    at_rest: bool = False


@dataclass(frozen=True)
class Stretch:
    """The first samples of a recording, to which the initial state of a plant is fitted.

    Attributes:
        start: evidence of the samples themselves.
        command: (samples,) [A or V].
        intervals: times between samples [s] if they are uneven, else empty.
        measured: (samples, signals), SI units; NaN where nothing was measured.
        noise: (signals,) standard deviations.
        settings: thresholds.
        loop: in which the stretch is replayed; under the commands without.
    """

    start: Start
    command: Floats
    intervals: Floats
    measured: Floats
    noise: Floats
    settings: InitialStates
    loop: Loop | None = None

    def command_before(self, at_rest: bool) -> float:
        """The command before the first sample: none at rest, where states that lag behind commands begin at zero."""
        return float(self.command[0]) if self.start.moving and not at_rest else 0.0

    def fit(self, plant: Plant) -> StartFit:
        """Fit the state of a plant to the stretch: the hub and the slowest mode of the beam first, then the faster ones too."""
        basis = self._basis(plant)
        if not len(basis):
            return StartFit(np.zeros(0), np.zeros(0))
        first = min(len(basis), (2 if self.start.moving else 0) + (2 if self.start.vibrating else 0))
        found = self._fit(plant, basis[:first], StartFit(np.zeros(first), np.zeros(first)))
        faster = len(basis) - first
        if faster:
            least = max(float(np.linalg.norm(found.moves[-2:])), self.settings.least_size)
            weights = np.concatenate([np.zeros(first), np.full(faster, 1.0 / (self.settings.faster_modes * least))])
            found = self._fit(plant, basis, StartFit(np.concatenate([found.moves, np.zeros(faster)]), weights))
        return replace(found, at_rest=not self._is_likelier_than_rest(plant, basis, found))

    def follow(self, plant: Plant, fitted: StartFit) -> StartFit:
        """Carry a fit of an arm along to one of other constants, by Gauss–Newton with the slopes of the first."""
        if fitted.step is None or fitted.at_rest:
            return fitted
        basis = self._basis(plant)
        best = self._residual(plant, self._state(plant, basis, fitted))
        for _ in range(self.settings.iterations):
            moved = replace(fitted, moves=fitted.moves + self._step(fitted, best))
            after = self._residual(plant, self._state(plant, basis, moved))
            if after @ after >= self.settings.gain * (best @ best):
                break
            fitted, best = moved, after
        return fitted

    def place(self, plant: Plant, fitted: StartFit) -> None:
        """Put a plant into a fitted state."""
        basis = self._basis(plant) if len(fitted.moves) and not fitted.at_rest else np.zeros((0, plant.states))
        plant.place(self._state(plant, basis, fitted), self.command_before(fitted.at_rest))

    def directions(self, plant: Plant) -> int:
        """Count the directions along which the state of a plant is fitted."""
        modes = _mode_count(plant, self.settings.modes) if self.start.vibrating else 0
        return (2 if self.start.moving else 0) + 2 * modes

    def _basis(self, plant: Plant) -> Floats:
        """Stack the directions (directions, states) of the hub, if it moves, and of the modes, if any vibrate."""
        hub = _hub_directions(plant) if self.start.moving else np.zeros((0, plant.states))
        return np.concatenate([hub, _mode_directions(plant, self.settings.modes)]) if self.start.vibrating else hub

    def _state(self, plant: Plant, basis: Floats, fitted: StartFit) -> Floats:
        """Compute the physical state (states,) of a fit along a basis."""
        hub, start = _hub_directions(plant), self.start
        if fitted.at_rest:
            return np.asarray(start.rest * hub[0])
        return np.asarray(np.array([start.angle, start.speed]) @ hub + fitted.moves @ basis)

    def _residual(self, plant: Plant, state: Floats, at_rest: bool = False) -> Floats:
        """Compute the error of every reading over its standard deviation (rows,); 0 where nothing was measured."""
        plant.place(state, self.command_before(at_rest))
        if self.loop is None:
            readings = plant.replay(self.command, self.intervals, NO_GAINS, NOT_MEASURED)
        else:
            readings = play_loop(plant, self.loop, self.intervals).readings
        return bounded(-errors_of(self.measured, readings, self.noise)).ravel()

    def _is_likelier_than_rest(self, plant: Plant, basis: Floats, fitted: StartFit) -> bool:
        """Whether the fitted state meets the stretch better than rest by more than chance: gages may have offsets."""
        states = [(self._state(plant, basis, replace(fitted, at_rest=at_rest)), at_rest) for at_rest in (True, False)]
        left, best = (float(np.sum(self._residual(plant, *state) ** 2)) for state in states)
        significant = self.settings.significant**2 * max(1.0, best / count_of(self.measured))
        return left - best > significant

    def _fit(self, plant: Plant, basis: Floats, begun: StartFit) -> StartFit:
        """Move the state along a basis (directions, states) to meet the stretch best, by Gauss–Newton.

        One over the expected size of each direction is its weight, where errors that are left count as noise.
        """
        found, state, width = begun, self._state(plant, basis, begun), self.settings.difference
        best = self._residual(plant, state)
        level = max(1.0, float(np.sqrt(np.sum(best**2) / count_of(self.measured))))
        for _ in range(self.settings.iterations):
            slopes = [(self._residual(plant, state + width * direction) - best) / width for direction in basis]
            rows = np.vstack([np.array(slopes).T / level, np.diag(begun.weights)])
            step: Floats = np.linalg.pinv(rows.T @ rows, rcond=self.settings.least_seen**2, hermitian=True) @ rows.T
            found = replace(found, level=level, step=step)
            moved = replace(found, moves=found.moves + self._step(found, best))
            further = self._state(plant, basis, moved)
            after = self._residual(plant, further)
            if after @ after >= self.settings.gain * (best @ best):
                break
            state, best, found = further, after, moved
        return found

    def _step(self, fitted: StartFit, residual: Floats) -> Floats:
        """Compute the Gauss–Newton step (directions,) by a residual (rows,)."""
        assert fitted.step is not None
        change: Floats = fitted.step @ np.concatenate([-residual / fitted.level, -fitted.weights * fitted.moves])
        return change


def _hub_directions(plant: Plant) -> Floats:
    """Build the directions (2, states) of the hub's angle and its speed."""
    size, bodies = len(plant.model.names), plant.bodies
    rows = np.zeros((2, plant.states))
    rows[0, :bodies] = rows[1, size : size + bodies] = 1.0
    return _with_filters(plant, rows)


def _mode_count(plant: Plant, most: int) -> int:
    """Count the slowest clamped modes of the beam, at most some."""
    return min(most, len(plant.model.names) - plant.bodies)


def _mode_directions(plant: Plant, most: int) -> Floats:
    """Build the directions (2 modes, states) of the beam's slowest clamped modes: each deflected, then moving, at unit energy."""
    model, bodies, count = plant.model, plant.bodies, _mode_count(plant, most)
    size = len(model.names)
    if count == 0:
        return np.zeros((0, plant.states))
    squares, shapes = eigh(model.stiffness[bodies:, bodies:], model.mass[bodies:, bodies:], subset_by_index=[0, count - 1])
    shapes *= np.where(model.tip[bodies:] @ shapes < 0.0, -1.0, 1.0)  # of either sign; a fit carried along needs one
    modes = np.zeros((count, 2, plant.states))
    modes[:, 0, bodies:size] = shapes.T / np.sqrt(squares)[:, None]
    modes[:, 1, size + bodies : 2 * size] = shapes.T
    return _with_filters(plant, modes.reshape(-1, plant.states))


def _with_filters(plant: Plant, states: Floats) -> Floats:
    """Settle the filters of accelerometers in states (…, states), as if the motion had gone on for long."""
    size = 2 * len(plant.model.names)
    states[..., size:] += states[..., :size] @ plant.model.settled.T
    return states
