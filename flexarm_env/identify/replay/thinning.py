"""Recordings thinned to the rate that the arm needs: replays take as long as there are samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.settings import LEAST_FREQUENCY, Settings
from flexarm_env.plant.plant import NO_GAINS, NO_INTERVALS, NOT_MEASURED, Plant
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


def thin(
    arm: Arm, recordings: Sequence[Recording], noise: Floats, settings: Settings, rate: float | None
) -> tuple[list[Recording], list[str]]:
    """Keep every k-th sample of recordings, with the mean of the command since the one before it.

    The mean keeps the impulse of the command in each step, and so the motion of an arm that is slow beside it. The step is the
    longest that resolves the slow vibrations, the arm's own lags and the smallest delay that a diagnosis looks for, and at which
    the mean command moves no signal by more than a share of its noise.

    Args:
        arm: the model, with the recordings' signals alone.
        recordings: of the machine.
        noise: (signals,) standard deviation of the readings.
        settings: numbers of the method.
        rate: samples per second [Hz] to keep in place of that choice; 0 keeps all.

    Returns:
        The recordings, and a note for a person where they are thinned.

    Raises:
        InputError: for a rate above the recordings', one that leaves too few samples, and one beside stated torque noise.
    """
    interval = _interval(recordings)
    count = _count(arm, recordings, noise, settings, interval) if rate is None else _asked_count(arm, recordings, rate, settings)
    if count < 2:
        return list(recordings), []
    kept = f"thinned from {1.0 / interval:.4g} to {1.0 / (count * interval):.4g} Hz"
    why = "as asked" if rate is not None else "which vibrations, lags and commands allow; --rate 0 keeps all"
    thinned = [_thinned(r, count * interval) for r in recordings]
    for recording in thinned:
        for signal in arm.signals:
            if not np.isfinite(recording.signals[signal]).any():
                raise InputError(
                    f"rate {rate:g} Hz leaves no reading of {signal} in {recording.name}: give another, or 0 to keep all"
                )
    return thinned, [f"{kept}, {why}"]


def _interval(recordings: Sequence[Recording]) -> float:
    return float(np.median([r.sample_time for r in recordings]))


def _asked_count(arm: Arm, recordings: Sequence[Recording], rate: float, settings: Settings) -> int:
    recorded, shortest = 1.0 / _interval(recordings), min(map(len, recordings))
    if not 0.0 <= rate <= recorded * (1.0 + settings.preparation.uneven):
        raise InputError(f"rate {rate:g} Hz: give up to {recorded:.4g} Hz, at which it is recorded, or 0 to keep all samples")
    count = round(recorded / rate) if rate else 1
    if count > 1 and arm.constants["drive"]["torque_noise"] > 0.0:
        raise InputError(f"arm '{arm.name}' states torque_noise for each sample at {recorded:.4g} Hz: leave out the rate")
    fewest = settings.preparation.fewest_samples
    if count * fewest > shortest:
        raise InputError(f"rate {rate:g} Hz leaves {shortest // count} samples of a recording; at least {fewest} are needed")
    return count


def _count(arm: Arm, recordings: Sequence[Recording], noise: Floats, settings: Settings, interval: float) -> int:
    """Count the samples of a step. One where torque noise is stated for each, or where a sensor is slower than the rows."""
    numbers = settings.thinning
    gaps = any(np.isnan(r.signals[s]).any() for r in recordings for s in arm.signals)
    shortest = min(map(len, recordings))
    if gaps or arm.constants["drive"]["torque_noise"] > 0.0:
        return 1
    longest = min(
        numbers.longest_step,
        numbers.share_of_lag * _shortest_lag(arm, recordings),
        numbers.share_of_period / _slow_vibration(arm, interval, numbers.slowest),
    )
    count = min(int(longest / interval * (1.0 + settings.preparation.uneven)), shortest // numbers.fewest_samples)
    if count > 1:
        plants = [one.plant(interval) for one in _with_frictions(arm, recordings, settings)]
        while count > 1 and not all(
            _command_error(plant, recordings, noise, count * interval, settings) <= numbers.command_error for plant in plants
        ):
            count -= 1
    return max(count, 1)


def _with_frictions(arm: Arm, recordings: Sequence[Recording], settings: Settings) -> list[Arm]:
    """Give an arm as much Coulomb friction as it may have: what lets a hub creep under a noisy command holds another for good."""
    usual = with_friction(arm, [r.command for r in recordings], settings)
    if "coulomb" not in usual.effects:
        return [usual]
    path = "effects.coulomb.torque"
    return [usual.with_values({path: share * usual.value(path)}) for share in settings.thinning.frictions]


def _shortest_lag(arm: Arm, recordings: Sequence[Recording]) -> float:
    """Find the shortest time constant of sensors and drive, or period of a replayed control law [s]; infinite without any."""
    structure = arm.structure()
    lags = [structure.current_lag, *(float(channel.filter) for channel in structure.sensors.values())]
    for recording in recordings:
        law = recording.controller or arm.controller
        if law is not None and recording.reference is not None:
            lags.append(1.0 / law.rate if law.rate > 0.0 else recording.sample_time)
    return min((lag for lag in lags if lag > 0.0), default=float("inf"))


def _slow_vibration(arm: Arm, interval: float, slowest: int) -> float:
    """Find the fastest of the slowest vibrations of the free and of the held hub [Hz]; the rate's reciprocal without any."""
    found = [arm.linearise(mode, interval).vibrations()[0][:slowest] for mode in ("moving", "stuck")]
    return float(np.concatenate(found).max(initial=LEAST_FREQUENCY))


def with_friction(arm: Arm, commands: Sequence[Floats], settings: Settings) -> Arm:
    """Give an arm without Coulomb friction one of the usual size beside its commands: a machine may have what the model lacks."""
    if "coulomb" in arm.effects or not arm.can_have("coulomb"):
        return arm
    command = np.sqrt(np.mean([np.mean(one**2) for one in commands]))
    usual = arm.known["coulomb"].parameters["torque"].typical / settings.reference.torque
    return arm.with_effect("coulomb", torque=float(usual * arm.structure().torque_by_command * command))


def _command_error(plant: Plant, recordings: Sequence[Recording], noise: Floats, step: float, settings: Settings) -> float:
    """Simulate the error that mean commands make in a signal, rms over its noise in windows; that of the worst signal.

    Each window starts from the state under the recorded commands. Friction makes the error: a hub breaks away within a step.
    """
    squares, samples = np.zeros(len(noise)), 0
    for recording in recordings:
        kept = kept_samples(recording.time, step)
        steps = np.append(np.diff(recording.time), step)
        intervals = steps if np.ptp(steps[:-1]) > settings.preparation.uneven * step else NO_INTERVALS
        mean = np.repeat(_mean_command(recording, kept), np.diff(np.append(kept, len(steps))))
        plant.place()
        commands = [plant.delayed(command) for command in (mean, np.ascontiguousarray(recording.command))]
        length = max(round(settings.preparation.window / step), 1)
        for first in range(0, len(kept) - 1, length):
            window = kept[first : first + length + 1]
            part, state = slice(window[0], window[-1] + 1), plant.state.copy()
            played = []
            for command in commands:  # the recorded one last: its state is that of the next window
                plant.state[:] = state
                played.append(plant.play(command[part], intervals[part], NO_GAINS, NOT_MEASURED))
            squares += np.sum(((played[0] - played[1])[window - window[0]] / noise) ** 2, axis=0)
            samples += len(window)
    return float(np.sqrt(squares.max() / samples))


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
