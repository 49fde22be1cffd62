"""Where a recording starts: what its first samples say without a model, and the state that a plant gives them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from flexarm_env.plant.plant import NO_GAINS, NOT_MEASURED, Plant
from flexarm_env.sensors import known_sensors

Floats = NDArray[np.float64]

#: A hub within this many standard deviations of its first angle is still; time [s] for which it must be to count as held.
STILL, HELD_TIME = 10.0, 0.1
#: A beam signal of a held hub that scatters by this many standard deviations of its noise vibrates.
VIBRATES = 2.0
#: First samples that leave rest by this many standard deviations, and a first sample that is one of rest.
SIGNIFICANT, RESTS = 6.0, 3.0
FIRST_SAMPLES, FIRST_TIME = 20, 0.004
#: Longest stretch [s] to which the state at the start is fitted: of a held hub, of a moving one.
LONGEST_HELD, LONGEST_MOVING = 0.5, 0.15
#: And at least so many samples, however far apart.
FEWEST = 3
ITERATIONS, STEP = 3, 1e-4
#: Modes of the beam that may vibrate, and the size expected of the faster ones over that of the first.
MODES, FASTER_MODES = 4, 0.3
#: Directions that the stretch shows less than this, over the one that it shows best, stay at rest.
LEAST_SEEN = 1e-4


@dataclass(frozen=True)
class Start:
    """Hub angle [rad] and speed [rad/s] at the start, and the samples to which the rest is fitted.

    Attributes:
        moving: whether the hub moves: angle and speed are then fitted as well.
        vibrating: whether the beam does.
        samples: length of the stretch that is fitted.
    """

    angle: float
    speed: float
    moving: bool
    vibrating: bool
    samples: int


def find_start(time: Floats, measured: Floats, signals: list[str], noise: Floats) -> Start:
    """Return what the first samples of a recording say: at rest at zero wherever they allow it.

    Args:
        time: (samples,) [s], from 0.
        measured: (samples, signals), SI units.
        signals: names of the columns.
        noise: (signals,) standard deviations.
    """
    interval = time[1] - time[0]
    beam = np.array(["beam" in known_sensors()[s].needs for s in signals])
    angle, speed, still = _hub(time, measured, signals, noise)
    moving = speed != 0.0
    held = still * interval >= HELD_TIME
    if held:
        vibrating = bool(np.any((measured[:still].std(axis=0) > VIBRATES * noise)[beam]))
    else:
        first = measured[: max(2, int(FIRST_TIME / interval))].mean(axis=0)
        vibrating = bool(np.any((np.abs(first) > SIGNIFICANT * noise)[beam]))
    longest = max(int((LONGEST_HELD if held else LONGEST_MOVING) / interval), FEWEST)
    samples = min(longest, still) if held else min(longest, len(time))
    return Start(angle, speed, moving, vibrating, samples)


def _hub(time: Floats, measured: Floats, signals: list[str], noise: Floats) -> tuple[float, float, int]:
    """Angle and speed of the hub at the start, and for how many samples it is still."""
    if "arm_angle" not in signals:
        return 0.0, _speed_alone(measured, signals, noise), 0
    column = signals.index("arm_angle")
    angle, sigma = measured[:, column], noise[column]
    leaves = np.abs(angle - angle[:3].mean()) > STILL * sigma
    turns = rests = False
    if "motor_speed" in signals:
        tach = signals.index("motor_speed")
        leaves |= np.abs(measured[:, tach]) > SIGNIFICANT * noise[tach]
        turns = abs(measured[:3, tach].mean()) > SIGNIFICANT * noise[tach]
        rests = bool(abs(measured[0, tach]) < RESTS * noise[tach])
    still = int(np.argmax(leaves)) if leaves.any() else len(angle)
    count = min(len(angle), FIRST_SAMPLES)
    if still < count and not rests:  # curved, since an arm that is driven at once moves too
        fit, spread = np.polyfit(time[:count], angle[:count], 2, cov="unscaled")
        if turns or abs(fit[1]) > SIGNIFICANT * sigma * np.sqrt(spread[1, 1]):
            return float(fit[2]), float(fit[1]), 0
    before = max(still // 2, 1)
    at_zero = abs(angle[: min(before, 3)].mean()) < 4.0 * sigma
    return 0.0 if at_zero else float(angle[:before].mean()), 0.0, still


def _speed_alone(measured: Floats, signals: list[str], noise: Floats) -> float:
    """Speed at the start where nothing shows the hub's angle; the motor's, until the rest is fitted."""
    if "motor_speed" not in signals:
        return 0.0
    tach = signals.index("motor_speed")
    first = float(measured[:3, tach].mean())
    rests = abs(measured[0, tach]) < RESTS * noise[tach] or abs(first) < SIGNIFICANT * noise[tach]
    return 0.0 if rests else first


def place_at_start(plant: Plant, start: Start, command: Floats, intervals: Floats, measured: Floats, noise: Floats) -> None:
    """Put a plant where a recording starts: in the state from which it meets the first samples best.

    Args:
        plant: a compiled arm.
        start: what the samples say without it.
        command: (samples,) of the recording.
        intervals: times between samples if they are uneven.
        measured: (samples, signals).
        noise: (signals,) standard deviations.
    """
    before = float(command[0]) if start.moving else 0.0  # an arm at rest was not driven: what lags behind commands begins there
    state = np.zeros(plant.states)
    hub, modes = _hub_directions(plant), _mode_directions(plant) if start.vibrating else []
    state += np.array([start.angle, start.speed]) @ hub
    basis = [*(hub if start.moving else []), *(modes[0] if modes else [])]
    if basis:
        stretch = _Stretch(plant, command[: start.samples], intervals[: start.samples], measured[: start.samples], noise, before)
        fitted, sizes = stretch.fit(state, np.array(basis), np.zeros(len(basis)))
        if len(modes) > 1:
            least = max(float(np.linalg.norm(sizes[-2:])), 1e-12)
            faster = np.concatenate(modes[1:])
            weights = np.array([0.0] * len(basis) + [1.0 / (FASTER_MODES * least)] * len(faster))
            fitted, _ = stretch.fit(fitted, np.array([*basis, *faster]), weights)
        state = stretch.likelier(start.angle * hub[0], fitted)
    plant.place(state, before)


def _hub_directions(plant: Plant) -> Floats:
    """Return (2, states): the hub's angle and its speed."""
    size, bodies = len(plant.model.names), plant.bodies
    rows = np.zeros((2, plant.states))
    rows[0, :bodies] = rows[1, size : size + bodies] = 1.0
    return _with_filters(plant, rows)


def _mode_directions(plant: Plant) -> list[Floats]:
    """Return (2, states) for each of the beam's slowest clamped modes: deflected and moving, at unit energy."""
    model, bodies = plant.model, plant.bodies
    size = len(model.names)
    most = min(MODES, size - bodies)
    if most == 0:
        return []
    squares, shapes = eigh(model.stiffness[bodies:, bodies:], model.mass[bodies:, bodies:], subset_by_index=[0, most - 1])
    modes = np.zeros((most, 2, plant.states))
    modes[:, 0, bodies:size] = shapes.T / np.sqrt(squares)[:, None]
    modes[:, 1, size + bodies : 2 * size] = shapes.T
    return list(_with_filters(plant, modes))


def _with_filters(plant: Plant, states: Floats) -> Floats:
    """Return states (…, states) whose filtered accelerations are zero: the motion has gone on as it is for long."""
    size = 2 * len(plant.model.names)
    states[..., size:] += states[..., :size] @ plant.model.settled.T
    return states


class _Stretch:
    """The first samples of a recording, to which a plant's state is fitted."""

    def __init__(self, plant: Plant, command: Floats, intervals: Floats, measured: Floats, noise: Floats, before: float) -> None:
        self.plant, self.command, self.intervals, self.measured = plant, command, intervals, measured
        self.sigma, self.before = noise, before

    def residual(self, state: Floats) -> Floats:
        """Return the error of every reading over its standard deviation (rows,)."""
        self.plant.place(state, self.before)
        readings = self.plant.replay(self.command, self.intervals, NO_GAINS, NOT_MEASURED)
        return np.nan_to_num((readings - self.measured) / self.sigma, nan=1e6, posinf=1e6, neginf=-1e6).ravel()

    def likelier(self, rest: Floats, fitted: Floats) -> Floats:
        """Return the state at rest unless the fitted one meets the stretch better by more than chance: gages may have offsets."""
        left, best = (float(np.sum(self.residual(state) ** 2)) for state in (rest, fitted))
        return fitted if left - best > SIGNIFICANT**2 * max(1.0, best / self.measured.size) else rest

    def fit(self, state: Floats, basis: Floats, weights: Floats) -> tuple[Floats, Floats]:
        """Return the state moved along a basis (directions, states) to meet the stretch best, and by how much (directions,).

        Gauss-Newton with one over the expected size of each direction as its weight, where errors that are left count as noise.
        """
        best, moved = self.residual(state), np.zeros(len(basis))
        level = max(1.0, float(np.sqrt(np.mean(best**2))))
        for _ in range(ITERATIONS):
            slopes = np.array([(self.residual(state + STEP * direction) - best) / STEP for direction in basis]).T / level
            rows = np.vstack([slopes, np.diag(weights)])
            step = np.linalg.lstsq(rows, np.concatenate([-best / level, -weights * moved]), rcond=LEAST_SEEN)[0]
            after = self.residual(state + step @ basis)
            if after @ after >= 0.999 * (best @ best):
                break
            state, best, moved = state + step @ basis, after, moved + step
        return state, moved
