"""A recording beside the model's free run under its commands, both as means over short cells of time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.agreement import Agreement, agreement, agreement_at, agreement_filtered, agreement_late
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.initial_state import Start, find_start
from flexarm_env.identify.replay.reading_noise import NoiseBySignal
from flexarm_env.identify.replay.replay import replay
from flexarm_env.identify.settings import MotionFaults, Settings
from flexarm_env.plant.plant import Plant
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]
Table = dict[str, Agreement]


@dataclass(frozen=True)
class FreeRun:
    """A recording beside the model's free run.

    Attributes:
        signals: names in the order of the columns.
        cell: length of a cell [s].
        measured: (cells, signals) means, SI units; NaN where a signal has no value for long.
        modelled: (cells, signals) means of the model's readings.
        integrals: (cells, signals) means of the measured signals' integrals over time.
        noise: (signals,) standard deviation of a cell's mean, as the arm states it.
        numbers: of the method.
    """

    signals: tuple[str, ...]
    cell: float
    measured: Floats
    modelled: Floats
    integrals: Floats
    noise: Floats
    numbers: MotionFaults

    def agreement(self, signal: str, model: str) -> Agreement:
        """Compare a measured signal with a modelled one, without a lag."""
        return agreement(*self._pair(signal, model), self.cell, self.numbers)

    def at_once(self) -> Table:
        """Compare every signal with its model, without a lag."""
        return {signal: self.agreement(signal, signal) for signal in self.signals}

    def late(self) -> Table:
        """Compare every signal with its model, at the lag of each."""
        return {signal: agreement_late(*self._pair(signal, signal), self.cell, self.numbers) for signal in self.signals}

    def late_by(self, lag: float) -> Table:
        """Compare every signal with its model at one lag [s]."""
        return {signal: agreement_at(*self._pair(signal, signal), lag, self.cell, self.numbers) for signal in self.signals}

    def filtered(self, signal: str) -> Agreement:
        """Compare a signal with its model behind the first-order filter with which they agree best."""
        return agreement_filtered(*self._pair(signal, signal), self.cell, self.numbers)

    def hub(self, gear_ratio: float, angle: str = "arm_angle", speed: str = "motor_speed") -> Agreement:
        """Compare the column of an angle with the integral of that of a motor's speed over the gear ratio."""
        return agreement(*self._turned(gear_ratio, angle, speed), self.cell, self.numbers)

    def hub_late(self, gear_ratio: float) -> Agreement:
        """Compare them at the lag of the angle behind the speed at which they agree best."""
        return agreement_late(*self._turned(gear_ratio, "arm_angle", "motor_speed"), self.cell, self.numbers)

    def _turned(self, gear_ratio: float, angle: str, speed: str) -> tuple[Floats, Floats]:
        return self.measured[:, self.signals.index(angle)], self.integrals[:, self.signals.index(speed)] / gear_ratio

    def leaves_noise(self, signal: str, found: Agreement) -> bool:
        """Whether an agreement leaves hardly more of a signal than its noise."""
        if not found.power:
            return False
        scale = max(abs(found.gain), 1.0)
        noise = (scale * float(self.noise[self.signals.index(signal)])) ** 2 / found.power
        return found.share + noise > self.numbers.exact

    def _pair(self, signal: str, model: str) -> tuple[Floats, Floats]:
        return self.measured[:, self.signals.index(signal)], self.modelled[:, self.signals.index(model)]


@dataclass(frozen=True)
class Replayer:
    """An arm and one recording, prepared for free runs.

    Attributes:
        arm: with the sensors of the recording, and their noise.
        plant: the arm with what the recording states.
        dataset: the recording alone, with its initial state, and the noise of the signals that give that.
        noise: (signals,) standard deviation of the readings.
    """

    arm: Arm
    plant: Plant
    dataset: Dataset
    noise: Floats

    def of(self, arm: Arm) -> Replayer:
        """Replay the recording by another arm, with other constants."""
        (plant,) = self.dataset.plants(arm).values()
        return replace(self, arm=arm, plant=plant)

    def free_run(self, command_factor: float = 1.0) -> FreeRun:
        """Replay the commands divided by a factor."""
        dataset = self.dataset
        numbers, run = dataset.settings.motion, dataset.runs[0]
        modelled = replay(self.plant, replace(run, command=run.command / command_factor), dataset)
        cell = max(dataset.interval, numbers.cell)
        measured, means, integrals = (
            cell_means(run.time, values, cell, numbers.longest_gap)
            for values in (run.measured, modelled, _integrals(run.time, run.measured))
        )
        noise = self.noise * math.sqrt(dataset.interval / cell)
        return FreeRun(dataset.signals, cell, measured, means, integrals, noise, numbers)


def replayer(arm: Arm, recording: Recording, settings: Settings, noises: NoiseBySignal | None = None) -> Replayer:
    """Prepare a recording for free runs of an arm, from the initial state with which the signals agree best.

    Args:
        arm: the model.
        recording: of the machine.
        settings: numbers of the method.
        noises: of the arm's sensors, where they were settled before.

    Raises:
        InputError: for a recording that does not fit the arm.
    """
    reduced, dataset = prepare(arm, [recording], settings, noises=noises)
    (plant,) = dataset.plants(reduced).values()
    tried = [Replayer(reduced, plant, started, dataset.noise) for started in _starts(dataset)]
    return max(tried, key=_agreed) if len(tried) > 1 else tried[0]


def _agreed(tried: Replayer) -> float:
    return sum(found.share for found in tried.free_run().late().values())


def _starts(dataset: Dataset) -> Iterator[Dataset]:
    """Yield the dataset with its start as read; where that is not at rest, also as each signal alone gives it, and at rest."""
    run, settings = dataset.runs[0], dataset.settings.initial_states
    yield dataset
    if not (run.start.moving or run.start.vibrating):
        return
    for column, signal in enumerate(dataset.signals):
        start = find_start(run.time, run.command, run.measured[:, [column]], [signal], dataset.noise[[column]], settings)
        others = np.full_like(dataset.noise, np.inf)
        others[column] = dataset.noise[column]
        yield replace(dataset, runs=(replace(run, start=start),), noise=others)
    rest = Start(0.0, 0.0, moving=False, vibrating=False, samples=run.start.samples, rest=0.0)
    yield replace(dataset, runs=(replace(run, start=rest),))


def _integrals(time: Floats, values: Floats) -> Floats:
    """Integrate samples (samples, signals) over time before they are averaged, which would lose fast motion."""
    integrals = np.full_like(values, np.nan)
    for column, signal in enumerate(values.T):
        known = np.isfinite(signal)
        if known.any():
            steps = 0.5 * np.diff(time[known]) * (signal[known][1:] + signal[known][:-1])
            integrals[known, column] = np.concatenate([[0.0], np.cumsum(steps)])
    return integrals


def cell_means(time: Floats, values: Floats, cell: float, longest_gap: int) -> Floats:
    """Average samples over cells of time; readings that are not finite do not count.

    Args:
        time: (samples,) [s], from 0.
        values: (samples, signals).
        cell: length of a cell [s].
        longest_gap: cells without a reading that are bridged by a straight line.

    Returns:
        (cells, signals); NaN in longer gaps.
    """
    place = np.floor((time + 0.5 * np.median(np.diff(time))) / cell).astype(int)
    means = np.full((place[-1] + 1, values.shape[1]), np.nan)
    for column, signal in enumerate(values.T):
        known = np.isfinite(signal)
        counts = np.bincount(place[known], minlength=len(means))
        sums = np.bincount(place[known], weights=signal[known], minlength=len(means))
        full = np.flatnonzero(counts)
        if len(full):
            means[:, column] = _bridged(len(means), full, sums[full] / counts[full], longest_gap)
    return means


def _bridged(count: int, full: NDArray[np.intp], means: Floats, longest_gap: int) -> Floats:
    """Bridge short gaps between cells with readings, (count,)."""
    cells = np.arange(count)
    bridged = np.interp(cells, full, means)
    after = np.minimum(np.searchsorted(full, cells), len(full) - 1)
    before = np.maximum(np.searchsorted(full, cells, side="right") - 1, 0)
    bridged[np.abs(full[after] - full[before]) > longest_gap + 1] = np.nan
    bridged[(cells < full[0]) | (cells > full[-1])] = np.nan
    return bridged
