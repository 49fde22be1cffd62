"""Faults put into recordings, each of a random size."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexarm_env import Arm, Recording, simulate
from flexarm_env.parameters import reading_noise

Rng = np.random.Generator
Floats = np.ndarray


@dataclass(frozen=True)
class Truth:
    """The fault that was put in: its kind, signal and size, and the recordings that hold it.

    Attributes:
        kind: one of `flexarm_env.identify.inspect.fault.KINDS`.
        signal: at fault; "" for all.
        value: as the kind has it.
        recordings: names.
        other: the other signal of an exchange.
    """

    kind: str
    signal: str
    value: float
    recordings: tuple[str, ...]
    other: str = ""


Injected = tuple[list[Recording], Truth] | None
UNITS = (360 / math.tau, 1 / math.tau, 60 / math.tau, 4.0, 0.25, 2.0, 10.0, 0.1, 1000.0)


def _with(recording: Recording, signal: str, values: Floats) -> Recording:
    return replace(recording, signals=recording.signals | {signal: values})


def _every(recordings: Sequence[Recording], signal: str, change: Callable[[Floats], Floats]) -> list[Recording]:
    return [_with(one, signal, change(one.signals[signal])) for one in recordings]


def _names(recordings: Sequence[Recording]) -> tuple[str, ...]:
    return tuple(one.name for one in recordings)


def _changed(before: Sequence[Recording], after: Sequence[Recording], signal: str, least: float) -> tuple[str, ...]:
    """Name the recordings in which more than a share of a signal's readings differ."""
    pairs = zip(before, after, strict=True)
    return tuple(b.name for a, b in pairs if np.mean(a.signals[signal] != b.signals[signal]) > least)


def factor(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Give a signal in another unit, on the other side of the gear, or with another gain."""
    gear = arm.constants["drive"]["gear_ratio"]
    sizes = [*UNITS, *([gear, 1 / gear] if gear != 1.0 else [])]
    value = float(rng.choice(sizes)) if rng.random() < 0.7 else float(np.exp(rng.choice([-1, 1]) * rng.uniform(0.4, 3.0)))
    return _every(recordings, signal, lambda y: value * y), Truth("factor", signal, value, _names(recordings))


def sign(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Turn a signal or the command round."""
    if rng.random() < 0.2:
        turned = [replace(one, command=-one.command) for one in recordings]
        return turned, Truth("sign", recordings[0].input_kind, -1.0, _names(recordings))
    return _every(recordings, signal, lambda y: -y), Truth("sign", signal, -1.0, _names(recordings))


def swapped(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Exchange two signals."""
    others = [name for name in recordings[0].signals if name != signal]
    if not others:
        return None
    other = str(rng.choice(others))
    made = [replace(one, signals=one.signals | {signal: one.signals[other], other: one.signals[signal]}) for one in recordings]
    return made, Truth("swapped", signal, 0.0, _names(recordings), other)


def clock(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Let all signals come late."""
    late = round(float(rng.uniform(0.05, 0.6)) / recordings[0].sample_time)
    made = [
        replace(one, signals={name: np.r_[np.full(late, y[0]), y[:-late]] for name, y in one.signals.items()})
        for one in recordings
    ]
    return made, Truth("clock", "", late * recordings[0].sample_time, _names(recordings))


def wrap(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Keep a reading within a range of one modulus."""
    signal = "arm_angle" if "arm_angle" in recordings[0].signals and rng.random() < 0.8 else signal
    values = np.concatenate([one.signals[signal] for one in recordings])
    if signal == "arm_angle" and np.ptp(values) > 0.5 and rng.random() < 0.4:
        modulus, low = math.tau, float(rng.choice([-math.pi, 0.0]))
    else:
        modulus, low = float(np.ptp(values) * rng.uniform(0.2, 0.9)), float(rng.uniform(values.min(), values.max()))
    made = _every(recordings, signal, lambda y: low + np.mod(y - low, modulus))
    steps = max(float(np.quantile(np.abs(np.diff(one.signals[signal])), 0.99)) for one in recordings)
    holds = tuple(a.name for a, b in zip(recordings, made, strict=True) if _crosses(a, b, signal))
    return (made, Truth("wrap", signal, modulus, holds)) if holds and steps < 0.2 * modulus else None


def _crosses(before: Recording, after: Recording, signal: str) -> bool:
    turns = np.round(before.signals[signal] - after.signals[signal], 9)
    shares = np.unique(turns, return_counts=True)[1] / len(turns)
    return bool(np.sum(shares > 0.02) > 1)


def rail(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Cut a signal off at both ends or at one."""
    extreme = float(np.quantile(np.abs(np.concatenate([one.signals[signal] for one in recordings])), rng.uniform(0.8, 0.99)))
    low = -extreme if rng.random() < 0.7 else -math.inf
    made = _every(recordings, signal, lambda y: np.clip(y, low, extreme))
    holds = _changed(recordings, made, signal, 0.01)
    return (made, Truth("rail", signal, extreme, holds)) if holds else None


def constant(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Unplug a sensor."""
    value = float(rng.choice([0.0, rng.normal()]))
    return _every(recordings, signal, lambda y: np.full_like(y, value)), Truth("constant", signal, value, _names(recordings))


def held(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Repeat each reading, as of a slower sensor."""
    count = int(rng.integers(2, 21))
    phase = int(rng.integers(count))
    made = _every(recordings, signal, lambda y: y[np.maximum((np.arange(len(y)) + phase) // count * count - phase, 0)])
    return made, Truth("held", signal, count, _names(recordings))


def _one(rng: Rng, recordings: list[Recording], signal: str, values: Callable[[Floats], Floats]) -> tuple[list[Recording], str]:
    place = int(rng.integers(len(recordings)))
    changed = _with(recordings[place], signal, values(recordings[place].signals[signal].copy()))
    return [*recordings[:place], changed, *recordings[place + 1 :]], changed.name


def _visible(arm: Arm, recordings: list[Recording], signal: str) -> float:
    """Compute the height from which a reading stands out of a signal for a person."""
    largest = max(float(np.abs(np.diff(one.signals[signal])).max()) for one in recordings)
    return max(3.0 * largest, 60.0 * reading_noise(arm.sensors[signal]))


def spike(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Put in single wild readings."""
    height = _visible(arm, recordings, signal) * float(np.exp(rng.uniform(0.3, 2.5)))
    count = int(rng.integers(1, 20))

    def change(y: Floats) -> Floats:
        places = rng.choice(np.arange(5, len(y) - 5, 3), count, replace=False)
        heights = height * np.r_[1.0, rng.uniform(0.5, 1.0, count - 1)]
        y[places] += rng.choice([-1, 1], count) * heights
        return y

    made, name = _one(rng, recordings, signal, change)
    return made, Truth("spike", signal, height, (name,))


def dropout(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Put zeros, or another value, in the place of some readings."""
    place = int(rng.integers(len(recordings)))
    y = recordings[place].signals[signal].copy()
    value = 0.0 if rng.random() < 0.7 else float(rng.choice([-1.0, 1.0]) * 3.0 * np.abs(y).max())
    length = int(rng.integers(1 if value == 0.0 else 2, 40))  # a single reading of another value is a spike
    shown = np.flatnonzero(np.abs(y - value) > 1.2 * _visible(arm, recordings, signal))
    shown = shown[(shown > 5) & (shown < len(y) - length - 5)]
    shown = shown[np.abs(y[shown + length] - value) > 1.2 * _visible(arm, recordings, signal)]
    if not shown.size:
        return None
    start = int(rng.choice(shown))
    if np.sign(y[start] - value) != np.sign(y[start + length] - value):
        return None
    y[start : start + length] = value
    made = [*recordings[:place], _with(recordings[place], signal, y), *recordings[place + 1 :]]
    return made, Truth("dropout", signal, value, (made[place].name,))


def limit(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Command more than the drive gives: the file holds the command, the machine got what the amplifier let through."""
    largest = arm.constants["drive"]["limit"]
    place = int(rng.integers(len(recordings)))
    one = recordings[place]
    if not largest:
        return None
    size = float(rng.uniform(1.1, 3.0))
    command = one.command / np.abs(one.command).max() * size * largest
    played = simulate(arm, replace(one, command=np.clip(command, -largest, largest)), seed=int(rng.integers(2**31)))
    made = replace(played, command=command)
    return [*recordings[:place], made, *recordings[place + 1 :]], Truth("limit", one.input_kind, size, (one.name,))


def glued(rng: Rng, arm: Arm, recordings: list[Recording], signal: str) -> Injected:
    """Write two runs into one file, the clock going on."""
    first, second = (recordings[i] for i in rng.permutation(len(recordings))[:2])
    end = int(len(first) * rng.uniform(0.5, 1.0))
    step = first.sample_time
    pause = step * float(rng.choice([1.0, 1.0, 50.0, 500.0]))
    start = float(first.time[end - 1]) + pause
    jumps = [abs(second.signals[s][0] - first.signals[s][end - 1]) > _visible(arm, recordings, s) for s in first.signals]
    if not any(jumps):
        return None
    signals = {name: np.r_[y[:end], second.signals[name]] for name, y in first.signals.items()}
    made = Recording.from_arrays(
        first.name, np.r_[first.time[:end], start + second.time], first.input_kind,
        np.r_[first.command[:end], second.command], signals,
    )  # fmt: skip
    return [made, *(one for one in recordings if one is not first)], Truth("glued", "", start, (first.name,))


INJECTIONS: dict[str, Callable[[Rng, Arm, list[Recording], str], Injected]] = {
    "factor": factor,
    "sign": sign,
    "swapped": swapped,
    "clock": clock,
    "wrap": wrap,
    "rail": rail,
    "constant": constant,
    "held": held,
    "spike": spike,
    "dropout": dropout,
    "limit": limit,
    "glued": glued,
}


def inject(rng: Rng, kind: str, arm: Arm, recordings: list[Recording]) -> Injected:
    """Put one fault of a kind into recordings; None where these recordings cannot show it."""
    return INJECTIONS[kind](rng, arm, recordings, str(rng.choice(list(recordings[0].signals))))
