"""Recordings thinned to the rate that the arm needs: replays take as long as there are samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.replay.scales import inertia_of
from flexarm_env.identify.settings import Settings, Thinning
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


def thin(
    arm: Arm, recordings: Sequence[Recording], noise: Floats, settings: Settings, rate: float | None
) -> tuple[list[Recording], list[str]]:
    """Keep every k-th sample of recordings, with the mean of the command since the one before it.

    The mean keeps the impulse of the command in each step, and so the motion of a linear arm that is slow beside it. The step is
    the longest that resolves the fastest vibration in the signals, the arm's own lags and the smallest delay that a diagnosis
    looks for, and that moves the hub by less than the noise.

    Args:
        arm: the model, with the recordings' signals alone.
        recordings: of the machine.
        noise: (signals,) standard deviation of the readings.
        settings: numbers of the method.
        rate: samples per second [Hz] to keep in place of that choice; 0 keeps all.

    Returns:
        The recordings, and a note for a person where they are thinned.

    Raises:
        InputError: for a rate above the recordings', and for one beside stated torque noise.
    """
    interval = float(np.median([r.sample_time for r in recordings]))
    count = _count(arm, recordings, noise, settings, interval) if rate is None else _asked_count(arm, rate, interval, settings)
    if count < 2:
        return list(recordings), []
    kept = f"thinned from {1.0 / interval:.4g} to {1.0 / (count * interval):.4g} Hz"
    why = "as asked" if rate is not None else "which resolves the fastest vibration, lag and delay; --rate 0 keeps all"
    return [_thinned(r, count * interval) for r in recordings], [f"{kept}, {why}"]


def _asked_count(arm: Arm, rate: float, interval: float, settings: Settings) -> int:
    recorded = 1.0 / interval
    if not 0.0 <= rate <= recorded * (1.0 + settings.preparation.uneven):
        raise InputError(f"rate {rate:g} Hz: give up to {recorded:.4g} Hz, at which it is recorded, or 0 to keep all samples")
    count = round(recorded / rate) if rate else 1
    if count > 1 and arm.constants["drive"]["torque_noise"] > 0.0:
        raise InputError(f"arm '{arm.name}' states torque_noise for each sample at {recorded:.4g} Hz: leave out the rate")
    return count


def _count(arm: Arm, recordings: Sequence[Recording], noise: Floats, settings: Settings, interval: float) -> int:
    """Count the samples of a step. One where torque noise is stated for each, or where a sensor is slower than the rows."""
    numbers = settings.thinning
    gaps = any(np.isnan(r.signals[s]).any() for r in recordings for s in arm.signals)
    shortest = min(map(len, recordings))
    if gaps or arm.constants["drive"]["torque_noise"] > 0.0:
        return 1
    longest = min(numbers.longest_step, _shortest_lag(arm) * numbers.share_of_lag)
    count = min(int(longest / interval * (1.0 + settings.preparation.uneven)), shortest // numbers.fewest_samples)
    if count < 2:
        return 1
    fastest = fastest_vibration(arm, recordings, noise, interval, numbers)
    count = min(count, int(1.0 / (interval * numbers.samples_per_period * fastest))) if fastest else count
    while count > 1 and _displacement(arm, recordings, noise, count * interval, settings) > numbers.displacement:
        count -= 1
    return max(count, 1)


def _shortest_lag(arm: Arm) -> float:
    """Find the shortest time constant of the arm's sensors and drive [s]; infinite without any."""
    structure = arm.structure()
    lags = [structure.current_lag, *(float(channel.filter) for channel in structure.sensors.values())]
    return min((lag for lag in lags if lag > 0.0), default=float("inf"))


def fastest_vibration(arm: Arm, recordings: Sequence[Recording], noise: Floats, interval: float, numbers: Thinning) -> float:
    """Find the highest eigenfrequency [Hz] at which a signal rises above its noise, or that always counts; 0 without any."""
    modes = [arm.linearise(mode, interval).vibrations()[0] for mode in ("moving", "stuck")]
    frequencies = np.concatenate(modes)
    found = max((float(mode[: numbers.always_seen].max(initial=0.0)) for mode in modes), default=0.0)
    for recording in recordings:
        for signal, deviation in zip(arm.signals, noise, strict=True):
            bins, power = _spectrum(recording.signals[signal], recording.sample_time, numbers.spectrum_samples)
            for frequency in frequencies[frequencies > found]:
                near = (bins > frequency / numbers.band) & (bins < frequency * numbers.band)
                if power[near].max(initial=0.0) > numbers.seen * deviation**2:
                    found = max(found, float(frequency))
    return found


def _spectrum(readings: Floats, interval: float, samples: int) -> tuple[Floats, Floats]:
    """Compute the largest power of a signal in any window by frequency [Hz]; white noise of variance 1 gives 1 on average.

    Second differences first, under a Hann taper: the power of slow motion would leak into the other bins.
    """
    change = np.diff(readings, 2)
    samples = min(samples, len(change))
    taper = np.hanning(samples + 2)[1:-1]
    rows = np.arange(0, len(change) - samples + 1, max(samples // 2, 1))[:, None] + np.arange(samples)
    bins = np.arange(1, samples // 2 + 1) / (samples * interval)
    power = np.abs(np.fft.rfft(change[rows] * taper, axis=1)).max(axis=0)[1:] ** 2 / np.sum(taper**2)
    return bins, power / (2.0 * np.sin(np.pi * bins * interval)) ** 4


def _displacement(arm: Arm, recordings: Sequence[Recording], noise: Floats, step: float, settings: Settings) -> float:
    """Estimate how far a step moves a free and rigid arm in a window, rms over the noise of its angle.

    The mean command gives the hub the same speed at the end of a step, and another angle.
    """
    if "arm_angle" not in arm.signals:
        return 0.0
    per_command = arm.structure().torque_by_command / inertia_of(arm)
    length = max(round(settings.preparation.window / step), 2)
    squares = []
    for recording in recordings:
        first = kept_samples(recording.time, step)
        durations = np.append(np.diff(recording.time), 0.0)
        group = np.repeat(np.arange(len(first)), np.diff(np.append(first, len(durations))))
        off = recording.command - _mean_command(recording, first)[group]
        end = np.append(recording.time[first[1:]], recording.time[-1])[group]
        moved = np.cumsum(np.add.reduceat(off * durations * (end - recording.time - durations / 2), first)) * per_command
        windows = [moved[start : start + length] - moved[start] for start in range(0, len(moved), length)]
        squares.append(np.mean(np.concatenate(windows) ** 2))
    return float(np.sqrt(np.mean(squares)) / noise[list(arm.signals).index("arm_angle")])


def kept_samples(time: Floats, step: float) -> NDArray[np.int64]:
    """Choose samples (kept,) by number: each time the last within a step [s] of the one before, and both ends of a gap.

    A rest at the end that is shorter than a step is left out: one odd step would cost the tables for an even one.
    """
    steps = np.diff(time)
    half = float(np.median(steps)) / 2
    if np.ptp(steps) < half:
        return np.arange(0, len(time), round(step / (2 * half)))
    kept = [0]
    while kept[-1] + 1 < len(time):
        last = int(np.searchsorted(time, time[kept[-1]] + step + half)) - 1
        kept.append(max(last, kept[-1] + 1))
    if len(kept) > 2 and time[kept[-1]] - time[kept[-2]] < step - half:
        kept.pop()
    return np.array(kept)


def _mean_command(recording: Recording, first: NDArray[np.int64]) -> Floats:
    """Compute the mean command (kept,) from each kept sample to the next, and the command of the last."""
    last = first[-1]
    impulse = np.add.reduceat(recording.command[:last] * np.diff(recording.time[: last + 1]), first[:-1])
    return np.append(impulse / np.diff(recording.time[first]), recording.command[first[-1]])


def _thinned(recording: Recording, step: float) -> Recording:
    """Thin one recording to a step [s]."""
    kept = kept_samples(recording.time, step)
    return replace(
        recording,
        time=recording.time[kept],
        command=_mean_command(recording, kept),
        signals={name: values[kept] for name, values in recording.signals.items()},
        reference=None if recording.reference is None else recording.reference[kept],
    )
