"""Where an arm fails: errors by signal, by regime of motion and by frequency band, against the noise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.explain.bands import band_rows
from flexarm_env.identify.explain.comparison import Comparison, LoopRow, Replay, Row
from flexarm_env.identify.progress import ProgressCallback
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.preflight import preflight
from flexarm_env.identify.replay.readings import count_of, errors_of
from flexarm_env.identify.replay.replay import loop_replay, replay, window_observers, window_replay
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.plant.plant import Plant
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
    notes = list(preflight(dataset).notes)
    plants = dataset.plants(reduced)
    observers = {stated: window_observers(reduced, plant, dataset) for stated, plant in plants.items()}
    replays = []
    for i, run in enumerate(dataset.runs):
        if progress:
            progress(i / len(dataset.runs), f"replaying {run.name}")
        plant = plants[run.stated]
        windows = window_replay(plant, run, dataset, observers[run.stated])
        free = replay(plant, run, dataset)
        one = _replay(run, dataset.signals, free, windows, regimes(run, dataset))
        replays.append(replace(one, closed=_closed(plant, run, dataset, arm.input)))
    rows = list(_rows(replays, dataset))
    whole = rows[-1]
    noise = {s: float(n) for s, n in zip(dataset.signals, dataset.noise, strict=True)}
    loop_rows = list(_loop_rows(replays, dataset, noise))
    closed_loop = _closed_loop_error(replays, noise) if loop_rows else None
    thinned = round(dataset.interval / float(np.median([r.sample_time for r in recordings]))) > 1
    kept = 1.0 / dataset.interval if thinned else 0.0
    return Comparison(arm, rows, replays, noise, whole.error, whole.free_run, notes, closed_loop, loop_rows, kept)


def regimes(run: Run, dataset: Dataset) -> NDArray[np.int64]:
    """Classify each sample (samples,): 0 where the measured hub is stuck, 1 where it moves slowly, 2 where fast.

    From the measured speed, or the slope of the measured angle; fast throughout where neither is measured. Between readings
    the speed is interpolated.
    """
    signal = next((name for name in ("motor_speed", "arm_angle") if name in dataset.signals), None)
    column = dataset.signals.index(signal) if signal else 0
    there = ~np.isnan(run.measured[:, column])
    if signal is None or there.sum() < 2:
        return np.full(len(run.time), 2, dtype=np.int64)
    time, speed, noise = run.time[there], run.measured[there, column], dataset.noise[column]
    if signal == "arm_angle":
        speed, noise = np.gradient(speed, time), noise / (dataset.interval / there.mean())
    if not there.all():
        speed = np.interp(run.time, time, speed)
    numbers = dataset.settings.explaining
    width = max(int(numbers.smoothing / dataset.interval), 1)
    readings = max((2 * width + 1) * there.mean(), 1.0)
    smooth = np.abs(np.convolve(np.pad(speed, width, mode="edge"), np.ones(2 * width + 1) / (2 * width + 1), "valid"))
    still = numbers.still * noise / np.sqrt(readings)
    moving = np.where(smooth > numbers.fast * np.abs(speed).max(), 2, 1)
    return np.where(smooth < still, 0, moving).astype(np.int64)


def _replay(run: Run, signals: Sequence[str], free: Floats, windows: Floats, regime: NDArray[np.int64]) -> Replay:
    def columns(values: Floats) -> dict[str, Floats]:
        return {signal: values[:, i] for i, signal in enumerate(signals)}

    return Replay(run.name, run.time, columns(run.measured), columns(free), columns(windows), regime)


def _closed(plant: Plant, run: Run, dataset: Dataset, kind: str) -> dict[str, Floats]:
    """Replay a run in closed loop; give its signals, and its command by its kind; nothing where the loop is not known."""
    if run.loop is None:
        return {}
    found = loop_replay(plant, run, run.loop, dataset)
    return {**{signal: found.readings[:, i] for i, signal in enumerate(dataset.signals)}, kind: found.command}


def _loop_rows(replays: Sequence[Replay], dataset: Dataset, noise: Mapping[str, float]) -> Iterator[LoopRow]:
    for one, run in zip(replays, dataset.runs, strict=True):
        for name, closed in one.closed.items():
            measured = one.measured.get(name, run.command)
            there = ~np.isnan(measured)
            measured, modelled = measured[there], closed[there]
            rest, size = (float(np.linalg.norm(values)) for values in (measured - modelled, measured))
            error = rest / noise[name] / float(np.sqrt(len(measured))) if name in noise else float("nan")
            relative = 100 * rest / size if size else float("nan")
            yield LoopRow(one.name, name, error, fit_percent(measured, modelled), relative)


def _closed_loop_error(replays: Sequence[Replay], noise: Mapping[str, float]) -> float:
    """Measure the error over noise of all recordings in closed loop; those without a loop count in a free run."""
    scaled = []
    for one in replays:
        modelled = one.closed or one.free
        for signal, sigma in noise.items():
            there = ~np.isnan(one.measured[signal])
            scaled.append((one.measured[signal][there] - modelled[signal][there]) / sigma)
    return float(np.sqrt(np.mean(np.concatenate(scaled) ** 2)))


def _rows(replays: Sequence[Replay], dataset: Dataset) -> Iterator[Row]:
    for signal, noise in zip(dataset.signals, dataset.noise, strict=True):
        for one in replays:
            yield _row(one.name, signal, "all", [one], {signal: float(noise)})
        if len(replays) > 1:
            yield _row("all", signal, "all", replays, {signal: float(noise)})
        for code, regime in enumerate(REGIMES):
            yield _row("all", signal, regime, replays, {signal: float(noise)}, code)
        yield from band_rows(replays, signal, float(noise), dataset)
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
            windows += float(np.sum(errors_of(measured, one.windows[name][chosen], sigma) ** 2))
            free += float(np.sum(errors_of(measured, one.free[name][chosen], sigma) ** 2))
            count += count_of(measured)
    fit = float("nan")
    if signal != "all" and regime is None:
        measured, free_run = ([one.measured[signal] for one in replays], [one.free[signal] for one in replays])
        fit = fit_percent(np.concatenate(measured), np.concatenate(free_run))
    if not count:
        return Row(recording, signal, part, float("nan"), float("nan"), fit, 0)
    return Row(recording, signal, part, float(np.sqrt(windows / count)), float(np.sqrt(free / count)), fit, count)


def fit_percent(measured: Floats, model: Floats) -> float:
    """Compute 100 (1 − ‖y − ŷ‖ / ‖y − ȳ‖) [%], as MATLAB's compare does."""
    there = ~np.isnan(measured)
    measured, model = measured[there], model[there]
    spread = float(np.linalg.norm(measured - measured.mean()))
    return 100 * (1.0 - float(np.linalg.norm(measured - model)) / spread) if spread else float("nan")
