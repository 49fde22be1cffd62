"""How strongly an effect shows: the error over the noise that it leaves once the constants have been fitted, all on the rig.

The error in windows of 1 s is what a diagnosis decides on. Here a window begins with the hub where the machine has it: from the
difference of two runs the motion is taken out that follows from its angle and speed at the start of each window. Slopes tell how
strong an effect is; a refit in a few steps confirms it, since constants may make up for more than slopes foretell.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from benchmarks.machines.effects import Sized
from benchmarks.machines.experiments import Run
from benchmarks.machines.machine import record, shown
from benchmarks.machines.model import Model
from benchmarks.machines.spread import EXACT, spreads, with_values

Floats = NDArray[np.float64]

#: Length of a window, and of the part of it over which the state that it begins with is estimated [s].
WINDOW, START = 1.0, 0.15
#: Samples per second that are compared at most [Hz]; share of a prior's standard deviation by which a constant is moved.
RATE, STEP = 100.0, 0.3
#: Step by which the weight of a link, as a logarithm, and its direction [rad] are moved.
WEIGHT_STEP = 0.01
WEIGHT, DIRECTION = "effects.base_tilt.torque", "effects.base_tilt.uphill"
#: Difference over the noise beyond which a slope is taken from a smaller step.
MODERATE = 30.0
#: Steps of a refit, and the furthest that one moves a constant at first, over its prior.
STEPS, FURTHEST = 5, 1.0
#: Share of the strength by slopes that a refit must leave.
KEPT = 0.5
#: Relative tolerance of a strength; largest number of trials; weakest size that is tried over the largest.
NEAR, TRIALS, WEAKEST = 0.15, 12, 1e-6


class Yardstick:
    """The differences, over the noise, that effects and constants make to a machine's readings under given commands.

    Args:
        machine: with its true constants.
        runs: its experiments.
        hidden: the effects under which a loop gave the commands.
    """

    def __init__(self, machine: Model, runs: Sequence[Run], hidden: Sequence[Sized] = ()) -> None:
        self.machine, self.runs, self.rates = machine, runs, [run.rate for run in runs]
        self.noise = np.array([machine.arm.reading_noise(signal) for signal in machine.arm.sensors])
        self.spreads = spreads(machine, exact=())
        self.free = [path for path in (WEIGHT, DIRECTION) if path in machine.values]
        present = [sized.settings(machine) for sized in hidden]
        self.commands = [record(machine, run, present).command for run in runs]
        self.without = [self._read(machine, i, ()) for i in range(len(runs))]

    def _read(self, machine: Model, place: int, effects: Sequence[dict[str, float]]) -> tuple[Floats, Floats]:
        readings, speed = shown(machine, self.commands[place], self.rates[place], effects)
        paths = [f"sensors.{signal}.gain" for signal in machine.arm.sensors]
        gains = [machine.values[path] / self.machine.values[path] if path in EXACT else 1.0 for path in paths]
        return readings * gains, speed

    def difference(self, machine: Model, effects: Sequence[dict[str, float]] = (), sensor: bool = False) -> Floats:
        """Compute the difference (samples · signals,) that effects or other constants make, in standard deviations of the noise.

        Args:
            machine: with those constants.
            effects: settings of the rig.
            sensor: whether the motion itself is not changed.
        """
        parts = []
        for place, (readings, speed) in enumerate(self.without):
            other, other_speed = self._read(machine, place, effects)
            change = other - readings
            if not sensor:
                self._restart(change, other_speed - speed, self.rates[place])
            change /= self.noise
            parts.append(change[:: max(round(self.rates[place] / RATE), 1)].ravel("F"))
        return np.concatenate(parts)

    def _restart(self, change: Floats, speed: Floats, rate: float) -> None:
        """Take out of a difference (samples, signals), in each window, the motion that its hub begins with."""
        signals, ratio = list(self.machine.arm.sensors), self.machine.values["drive.gear_ratio"]
        length, first = round(WINDOW * rate), round(START * rate)
        carried = carried_on(self.machine, length, rate)
        means = carried[:first].mean(axis=0)
        for start in range(0, len(change), length):
            window = change[start : start + length]
            angle = window[:first, signals.index("arm_angle")].mean()
            begin = np.linalg.solve(means, [angle, speed[start : start + first].mean()])
            motion = carried[: len(window)] @ begin
            window[:, signals.index("arm_angle")] -= motion[:, 0]
            if "motor_speed" in signals:
                window[:, signals.index("motor_speed")] -= motion[:, 1] * ratio

    @property
    def paths(self) -> list[str]:
        """The values that a fit moves: constants with a prior, and the weight of a link and its direction without one."""
        return [*self.spreads, *self.free]

    @cached_property
    def columns(self) -> Floats:
        """Differences (readings, values) by one standard deviation of the prior of each constant, and by a unit of each other."""
        return self.slopes(np.zeros(len(self.paths)))

    def slopes(self, moved: Floats) -> Floats:
        """Compute the differences (readings, values) by a unit of each value, from where all of them were moved to."""
        here = self.difference(self.moved(moved)) if np.any(moved) else 0.0
        return np.stack([self._slope(place, moved, here) for place in range(len(moved))], axis=1)

    def _slope(self, place: int, moved: Floats, here: Floats | float) -> Floats:
        """Compute the difference (readings,) by a unit of a value, from a step that changes readings about as effects do.

        With a larger one the hub sticks at other times.
        """
        path = self.paths[place]
        step, sensor = WEIGHT_STEP if path in self.free else STEP, path.startswith("sensors.") and not np.any(moved)
        unit = (np.arange(len(moved)) == place).astype(float)
        change = self.difference(self.moved(moved + step * unit), sensor=sensor) - here
        if rms(change) > MODERATE:
            step *= MODERATE / rms(change)
            change = self.difference(self.moved(moved + step * unit), sensor=sensor) - here
        return change / step

    def moved(self, steps: Floats) -> Model:
        """Move constants by standard deviations of their priors, a weight by a logarithm, its direction by an angle [rad]."""
        by_path = dict(zip(self.paths, steps, strict=True))
        now = self.machine.values
        values = {path: now[path] * math.exp(step * self.spreads.get(path, 1.0)) for path, step in by_path.items()}
        return with_values(self.machine, values | {path: now[path] + by_path[path] for path in by_path if path == DIRECTION})

    def signature(self, sized: Sized) -> Floats:
        """Compute the difference (readings,) that an effect makes."""
        return self.difference(self.machine, (sized.settings(self.machine),), sized.is_sensor)

    def left(self, difference: Floats, rivals: Sequence[Floats] = ()) -> float:
        """Compute the rms of what constants within their priors, and weight and rivals of any size, cannot make up for."""
        columns = np.column_stack([self.columns, *rivals])
        return rms(difference - columns @ self._made_up(columns, difference, np.zeros(columns.shape[1])))

    def _made_up(self, columns: Floats, difference: Floats, moved: Floats) -> Floats:
        """Compute by how much constants, and what has no prior, move on from where they are to make up for a difference."""
        priors = np.diag((np.arange(columns.shape[1]) < len(self.spreads)).astype(float))
        return np.linalg.lstsq(np.vstack([columns, priors]), np.r_[difference, -priors @ moved])[0]

    def strength(self, sized: Sized) -> float:
        """Compute the rms of what constants cannot make up for of an effect."""
        return self.left(self.signature(sized))

    def refitted(self, sized: Sized) -> float:
        """Compute the rms that an effect leaves when the constants are refitted, in steps that are shorter where they lead up."""
        signature, moved = self.signature(sized), np.zeros(len(self.paths))
        left, furthest = signature, FURTHEST
        columns = self.columns
        for _ in range(STEPS):
            step = np.clip(self._made_up(columns, left, moved), -furthest, furthest)
            then = signature - self.difference(self.moved(moved + step))
            if rms(then) > rms(left):
                furthest /= 4.0
                continue
            moved, left = moved + step, then
            columns = self.slopes(moved)
        return rms(left)


def rms(difference: Floats) -> float:
    """Compute the root of the mean square."""
    return float(np.sqrt(np.mean(difference**2)))


def carried_on(machine: Model, count: int, rate: float) -> Floats:
    """Compute angle and speed (count, 2, 2) of a rigid hub left to itself, from a unit of angle and from one of speed."""
    values = machine.values
    damping = values.get("effects.viscous.coefficient", 0.0)
    if machine.arm.input == "voltage":
        damping += (values["drive.gear_ratio"] * values["drive.torque_constant"]) ** 2 / values["drive.resistance"]
    stiffness = values.get("effects.base_tilt.torque", 0.0)
    step = expm(np.array([[0.0, 1.0], [-stiffness / machine.inertia, -damping / machine.inertia]]) / rate)
    found = [np.eye(2)]
    while len(found) < count:
        found.append(step @ found[-1])
    return np.stack(found)


def find_size(yard: Yardstick, sized: Sized, wanted: float) -> Sized | None:
    """Find the size at which an effect of the largest plausible size is as strong as wanted; None where it never is.

    Its strength is that under the commands of the machine that has it: a loop drives through a dead zone, and past a limit. One
    that refitted constants make up for has none.
    """
    low, high = np.log(WEAKEST), 0.0  # logarithms of the share of that size
    share = 0.0
    for _ in range(TRIALS):
        made = replace(sized, size=sized.size * math.exp(share))
        strength = yard.strength(made)
        if abs(strength - wanted) < NEAR * wanted:
            own = Yardstick(yard.machine, yard.runs, (made,))
            strength = own.strength(made)
            if abs(strength - wanted) < NEAR * wanted:
                return replace(made, strength=strength) if own.refitted(made) > KEPT * wanted else None
        low, high = (low, share) if strength > wanted else (share, high)
        if high <= low:
            return None
        # most effects grow in proportion to their size, and some set in at once
        guess = share + float(np.log(wanted / max(strength, 1e-3 * wanted)))
        share = guess if low < guess < high else 0.5 * (low + high)
    return None
