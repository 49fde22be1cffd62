"""Where an arm fails: errors by signal, by regime of motion and by frequency band, against the noise."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.explain.comparison import Comparison, Replay, Row
from flexarm_env.identify.progress import ProgressCallback
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.preflight import preflight
from flexarm_env.identify.replay.replay import replay, window_observers, window_replay
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]

REGIMES = ("stuck", "moving slowly", "moving fast")


def compare(
    arm: Arm,
    recordings: Sequence[Recording],
    progress: ProgressCallback | None = None,
    settings: Settings = SETTINGS,
    rate: float | None = None,
) -> Comparison:
    """Replay recordings through an arm and measure where it fails. Nothing is fitted, so all samples count.

    Args:
        arm: the model.
        recordings: of the machine.
        progress: called with the share done and a text.
        settings: numbers of the method.
        rate: samples per second [Hz] that are kept; 0 keeps all. By default, as many as the arm needs.

    Raises:
        InputError: for recordings that do not fit the arm.

    Example:
        >>> from flexarm_env import Arm, compare, simulate
        >>> arm = Arm.load("thesis")
        >>> found = compare(arm, [simulate(arm, "pulse", duration=2.0, rate=200.0)])
        >>> 0.9 < found.error < 1.1
        True
    """
    reduced, dataset = prepare(arm, recordings, settings, rate)
    notes, _ = preflight(dataset)
    plants = dataset.plants(reduced)
    observers = {payload: window_observers(reduced, plant, dataset) for payload, plant in plants.items()}
    replays = []
    for i, run in enumerate(dataset.runs):
        if progress:
            progress(i / len(dataset.runs), f"replaying {run.name}")
        plant = plants[run.payload]
        windows = window_replay(plant, run, dataset, observers[run.payload])
        free = replay(plant, run, dataset)
        replays.append(_replay(run, dataset.signals, free, windows, regimes(run, dataset)))
    rows = list(_rows(replays, dataset))
    whole = rows[-1]
    noise = {s: float(n) for s, n in zip(dataset.signals, dataset.noise, strict=True)}
    return Comparison(arm, rows, replays, noise, whole.error, whole.free_run, notes)


def regimes(run: Run, dataset: Dataset) -> NDArray[np.int64]:
    """Classify each sample (samples,): 0 where the measured hub is stuck, 1 where it moves slowly, 2 where fast.

    From the measured speed, or the slope of the measured angle; fast throughout where neither is measured.
    """
    if "motor_speed" in dataset.signals:
        column = dataset.signals.index("motor_speed")
        speed, noise = run.measured[:, column], dataset.noise[column]
    elif "arm_angle" in dataset.signals:
        column = dataset.signals.index("arm_angle")
        speed = np.gradient(run.measured[:, column], run.time)
        noise = dataset.noise[column] / dataset.interval
    else:
        return np.full(len(run.time), 2, dtype=np.int64)
    numbers = dataset.settings.explaining
    width = max(int(numbers.smoothing / dataset.interval), 1)
    smooth = np.abs(np.convolve(np.pad(speed, width, mode="edge"), np.ones(2 * width + 1) / (2 * width + 1), "valid"))
    still = numbers.still * noise / np.sqrt(2 * width + 1)
    moving = np.where(smooth > numbers.fast * np.abs(speed).max(), 2, 1)
    return np.where(smooth < still, 0, moving).astype(np.int64)


def _replay(run: Run, signals: Sequence[str], free: Floats, windows: Floats, regime: NDArray[np.int64]) -> Replay:
    def columns(values: Floats) -> dict[str, Floats]:
        return {signal: values[:, i] for i, signal in enumerate(signals)}

    return Replay(run.name, run.time, columns(run.measured), columns(free), columns(windows), regime)


def _rows(replays: Sequence[Replay], dataset: Dataset) -> Iterator[Row]:
    for signal, noise in zip(dataset.signals, dataset.noise, strict=True):
        for one in replays:
            yield _row(one.name, signal, "all", [one], {signal: float(noise)})
        if len(replays) > 1:
            yield _row("all", signal, "all", replays, {signal: float(noise)})
        for code, regime in enumerate(REGIMES):
            yield _row("all", signal, regime, replays, {signal: float(noise)}, code)
        yield from _band_rows(replays, signal, float(noise), dataset)
    sigma = {s: float(n) for s, n in zip(dataset.signals, dataset.noise, strict=True)}
    for code, regime in enumerate(REGIMES):
        yield _row("all", "all", regime, replays, sigma, code)
    for one in replays:
        yield _row(one.name, "all", "all", [one], sigma)
    yield _row("all", "all", "all", replays, sigma)


def _row(
    recording: str,
    signal: str,
    part: str,
    replays: Sequence[Replay],
    noise: dict[str, float],
    regime: int | None = None,
) -> Row:
    windows, free, count = 0.0, 0.0, 0
    for one in replays:
        chosen = np.full(len(one.time), True) if regime is None else one.regime == regime
        for name, sigma in noise.items():
            measured = one.measured[name][chosen]
            windows += float(np.sum(((measured - one.windows[name][chosen]) / sigma) ** 2))
            free += float(np.sum(((measured - one.free[name][chosen]) / sigma) ** 2))
            count += int(chosen.sum())
    fit = float("nan")
    if signal != "all" and regime is None:
        measured, free_run = ([one.measured[signal] for one in replays], [one.free[signal] for one in replays])
        fit = fit_percent(np.concatenate(measured), np.concatenate(free_run))
    if not count:
        return Row(recording, signal, part, float("nan"), float("nan"), fit, 0)
    return Row(recording, signal, part, float(np.sqrt(windows / count)), float(np.sqrt(free / count)), fit, count)


def fit_percent(measured: Floats, model: Floats) -> float:
    """Compute 100 (1 − ‖y − ŷ‖ / ‖y − ȳ‖) [%], as MATLAB's compare does."""
    spread = float(np.linalg.norm(measured - measured.mean()))
    return 100 * (1.0 - float(np.linalg.norm(measured - model)) / spread) if spread else float("nan")


def _band_rows(replays: Sequence[Replay], signal: str, noise: float, dataset: Dataset) -> Iterator[Row]:
    """Measure errors over noise by frequency: white noise alone gives 1 in every band."""
    interval = dataset.interval
    nyquist = 0.5 / interval
    edges = [edge for edge in dataset.settings.explaining.bands if edge < nyquist] + [nyquist]
    power = np.zeros(len(edges) - 1)
    count = np.zeros(len(edges) - 1)
    for one in replays:
        error = one.measured[signal] - one.windows[signal]
        spectrum = np.abs(np.fft.rfft(error)) ** 2 / len(error)
        frequency = np.fft.rfftfreq(len(error), interval)
        place = np.clip(np.searchsorted(edges, frequency, side="right") - 1, 0, len(power) - 1)
        np.add.at(power, place, spectrum)
        np.add.at(count, place, 1.0)
    for low, high, p, c in zip(edges, edges[1:], power, count, strict=False):
        band_error = float(np.sqrt(p / c)) / noise if c else float("nan")
        yield Row("all", signal, f"{low:g}-{high:g} Hz", band_error, float("nan"), float("nan"), int(c))
