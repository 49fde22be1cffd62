"""The initial state of a recording: estimated from its first samples without a model, and fitted to them with a plant."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from flexarm_env.identify.replay.closed_loop import play_loop
from flexarm_env.identify.replay.loop import Loop
from flexarm_env.identify.replay.readings import bounded, count_of, errors_of, rms_of
from flexarm_env.identify.settings import InitialStates
from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant
from flexarm_env.sensors import known_sensors

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Start:
    """Evidence of the first samples on the initial state.

    Attributes:
        angle: of the hub [rad].
        speed: of the hub [rad/s].
        moving: true if the hub moves, so that angle and speed are fitted as well.
        vibrating: true if the beam vibrates.
        samples: length of the stretch to which the state is fitted.
    """

    angle: float
    speed: float
    moving: bool
    vibrating: bool
    samples: int


def find_start(time: Floats, measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> Start:
    """Read the evidence on the initial state from the first samples: at rest at zero wherever they allow it.

    Args:
        time: (samples,) [s], from 0.
        measured: (samples, signals), SI units; NaN where nothing was measured.
        signals: names of the columns.
        noise: (signals,) standard deviations.
        settings: thresholds.
    """
    begins = np.argmax(~np.isnan(measured), axis=0)
    early = time[begins] <= settings.held_time
    if early.all():
        return _start(time, measured, signals, noise, settings)
    known = [signal for signal, is_early in zip(signals, early, strict=True) if is_early]
    found = _start(time, measured[:, early], known, noise[early], settings)
    if "arm_angle" in known or "arm_angle" not in signals:
        return found
    first = time[begins[signals.index("arm_angle")]]
    samples = int(np.searchsorted(time, first + settings.longest_moving))
    return replace(found, moving=True, samples=max(found.samples, samples))


def _start(time: Floats, measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> Start:
    """Read the evidence on the initial state from signals that were measured at the start."""
    interval = time[1] - time[0]
    beam = np.array(["beam" in known_sensors()[s].needs for s in signals], dtype=bool)
    angle, speed, still = _hub(time, measured, signals, noise, settings)
    moving = speed != 0.0
    held = still * interval >= settings.held_time
    if held:
        vibrating = bool(np.any((_scatter(measured[:still]) > settings.vibrates * noise)[beam]))
    else:
        first = _means(measured[: max(2, int(settings.first_time / interval))])
        vibrating = bool(np.any((np.abs(first) > settings.significant * noise)[beam]))
    longest = max(int((settings.longest_held if held else settings.longest_moving) / interval), settings.fewest)
    samples = min(longest, still) if held else min(longest, len(time))
    return Start(angle, speed, moving, vibrating, samples)


def _hub(time: Floats, measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> tuple[float, float, int]:
    """Estimate angle and speed of the hub at the start, and count the samples for which it is still."""
    if "arm_angle" not in signals:
        return 0.0, _speed_alone(measured, signals, noise, settings), 0
    column = signals.index("arm_angle")
    angle, sigma = measured[:, column], noise[column]
    leaves = np.abs(angle - _first(angle).mean()) > settings.still * sigma
    turns = rests = False
    there = ~np.isnan(angle)
    if "motor_speed" in signals:
        tach = signals.index("motor_speed")
        leaves |= np.abs(measured[:, tach]) > settings.significant * noise[tach]
        turns = abs(_first(measured[:, tach]).mean()) > settings.significant * noise[tach]
        rests = bool(abs(_first(measured[:, tach])[0]) < settings.at_rest * noise[tach])
        there |= ~np.isnan(measured[:, tach])
    still = _samples_before(leaves, there)
    rows = np.flatnonzero(~np.isnan(angle))[: settings.first_samples]
    if still <= rows[-1] and not rests:  # curved, since an arm that is driven at once moves too
        fit, spread = np.polyfit(time[rows], angle[rows], 2, cov="unscaled")
        if turns or abs(fit[1]) > settings.significant * sigma * np.sqrt(spread[1, 1]):
            return float(fit[2]), float(fit[1]), 0
    before = max(still // 2, 1)
    at_zero = abs(_first(angle, min(before, 3)).mean()) < settings.at_zero * sigma
    return 0.0 if at_zero else float(_first(angle, before).mean()), 0.0, still


def _first(values: Floats, rows: int = 3) -> Floats:
    """Select the readings of a signal (samples,) in its first rows; where there are none yet, the first one."""
    there = np.flatnonzero(~np.isnan(values))
    return values[there[: max(int(np.searchsorted(there, rows)), 1)]]


def _samples_before(leaves: NDArray[np.bool_], there: NDArray[np.bool_]) -> int:
    """Count the samples up to the last reading before the first one that leaves; all of them where none does."""
    if not leaves.any():
        return len(leaves)
    before = np.flatnonzero(there[: np.argmax(leaves)])
    return int(before[-1]) + 1 if before.size else 0


def _means(measured: Floats) -> Floats:
    """Compute the mean (signals,) of the readings; 0 for a signal without any."""
    there = ~np.isnan(measured)
    return np.sum(measured, axis=0, where=there) / np.maximum(there.sum(axis=0), 1)


def _scatter(measured: Floats) -> Floats:
    """Compute the standard deviation (signals,) of the readings; 0 for a signal without any."""
    return rms_of(errors_of(measured, _means(measured)), measured)


def _speed_alone(measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> float:
    """Estimate the initial speed without an angle sensor: the motor's, until the state is fitted."""
    if "motor_speed" not in signals:
        return 0.0
    tach = signals.index("motor_speed")
    first = _first(measured[:, tach])
    mean = float(first.mean())
    rests = abs(first[0]) < settings.at_rest * noise[tach] or abs(mean) < settings.significant * noise[tach]
    return 0.0 if rests else mean


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

    @property
    def command_before(self) -> float:
        """The command before the first sample: none at rest, where states that lag behind commands begin at zero."""
        return float(self.command[0]) if self.start.moving else 0.0

    def set_fitted_state(self, plant: Plant) -> None:
        """Fit the state to the stretch, and put a plant into it."""
        start = self.start
        state = np.zeros(plant.states)
        hub, modes = _hub_directions(plant), _mode_directions(plant, self.settings.modes) if start.vibrating else []
        state += np.array([start.angle, start.speed]) @ hub
        basis = [*(hub if start.moving else []), *(modes[0] if modes else [])]
        if basis:
            fitted, sizes = self._fit(plant, state, np.array(basis), np.zeros(len(basis)))
            if len(modes) > 1:
                least = max(float(np.linalg.norm(sizes[-2:])), self.settings.least_size)
                faster = np.concatenate(modes[1:])
                weights = np.array([0.0] * len(basis) + [1.0 / (self.settings.faster_modes * least)] * len(faster))
                fitted, _ = self._fit(plant, fitted, np.array([*basis, *faster]), weights)
            state = self._likelier(plant, start.angle * hub[0], fitted)
        plant.place(state, self.command_before)

    def _residual(self, plant: Plant, state: Floats) -> Floats:
        """Compute the error of every reading over its standard deviation (rows,); 0 where nothing was measured."""
        plant.place(state, self.command_before)
        if self.loop is None:
            readings = plant.replay(self.command, self.intervals, NO_GAINS, NOT_MEASURED)
        else:
            readings = play_loop(plant, self.loop, self.intervals).readings
        return bounded(-errors_of(self.measured, readings, self.noise)).ravel()

    def _likelier(self, plant: Plant, rest: Floats, fitted: Floats) -> Floats:
        """Choose rest unless the fitted state meets the stretch better by more than chance: gages may have offsets."""
        left, best = (float(np.sum(self._residual(plant, state) ** 2)) for state in (rest, fitted))
        significant = self.settings.significant**2 * max(1.0, best / count_of(self.measured))
        return fitted if left - best > significant else rest

    def _fit(self, plant: Plant, state: Floats, basis: Floats, weights: Floats) -> tuple[Floats, Floats]:
        """Move the state along a basis (directions, states) to meet the stretch best; also give the moves (directions,).

        Gauss–Newton with one over the expected size of each direction as its weight, where errors that are left count as noise.
        """
        best, moved = self._residual(plant, state), np.zeros(len(basis))
        level = max(1.0, float(np.sqrt(np.sum(best**2) / count_of(self.measured))))
        width = self.settings.difference
        for _ in range(self.settings.iterations):
            slopes = (
                np.array([(self._residual(plant, state + width * direction) - best) / width for direction in basis]).T / level
            )
            rows = np.vstack([slopes, np.diag(weights)])
            target = np.concatenate([-best / level, -weights * moved])
            step = np.linalg.lstsq(rows, target, rcond=self.settings.least_seen)[0]
            after = self._residual(plant, state + step @ basis)
            if after @ after >= self.settings.gain * (best @ best):
                break
            state, best, moved = state + step @ basis, after, moved + step
        return state, moved


def _hub_directions(plant: Plant) -> Floats:
    """Build the directions (2, states) of the hub's angle and its speed."""
    size, bodies = len(plant.model.names), plant.bodies
    rows = np.zeros((2, plant.states))
    rows[0, :bodies] = rows[1, size : size + bodies] = 1.0
    return _with_filters(plant, rows)


def _mode_directions(plant: Plant, most: int) -> list[Floats]:
    """Build the directions (2, states) of each of the beam's slowest clamped modes: deflected and moving, at unit energy."""
    model, bodies = plant.model, plant.bodies
    size = len(model.names)
    count = min(most, size - bodies)
    if count == 0:
        return []
    squares, shapes = eigh(model.stiffness[bodies:, bodies:], model.mass[bodies:, bodies:], subset_by_index=[0, count - 1])
    modes = np.zeros((count, 2, plant.states))
    modes[:, 0, bodies:size] = shapes.T / np.sqrt(squares)[:, None]
    modes[:, 1, size + bodies : 2 * size] = shapes.T
    return list(_with_filters(plant, modes))


def _with_filters(plant: Plant, states: Floats) -> Floats:
    """Settle the filters of accelerometers in states (…, states), as if the motion had gone on for long."""
    size = 2 * len(plant.model.names)
    states[..., size:] += states[..., :size] @ plant.model.settled.T
    return states
