"""Recordings made by an arm's model: the experiments of a laboratory, with the noise of its sensors."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import overload

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.experiments.derivatives import full_path, tangents_of
from flexarm_env.experiments.plans import EXPERIMENTS, plan_of, random_stream
from flexarm_env.experiments.plausible import check_motion
from flexarm_env.experiments.rig import Rig
from flexarm_env.experiments.stated import PAYLOAD, check_stated, stated_by, with_stated
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]

MOST_SAMPLES = 10_000_000


#: Derivatives (n,) of the readings of each signal, by constant, then by signal.
Derivatives = Mapping[str, Mapping[str, Floats]]


@overload
def simulate(
    arm: Arm,
    input: str | os.PathLike[str] | Recording = ...,
    duration: float = ...,
    rate: float = ...,
    seed: int = ...,
    noise: bool = ...,
    name: str | None = ...,
) -> Recording: ...


@overload
def simulate(
    arm: Arm,
    input: str | os.PathLike[str] | Recording = ...,
    duration: float = ...,
    rate: float = ...,
    seed: int = ...,
    noise: bool = ...,
    name: str | None = ...,
    *,
    derivatives: Sequence[str],
) -> tuple[Recording, Derivatives]: ...


def simulate(
    arm: Arm,
    input: str | os.PathLike[str] | Recording = "pulse",
    duration: float = 10.0,
    rate: float = 500.0,
    seed: int = 0,
    noise: bool = True,
    name: str | None = None,
    derivatives: Sequence[str] | None = None,
) -> Recording | tuple[Recording, Derivatives]:
    """Simulate an arm from rest at angle 0 and record it. The same arguments give the same bits.

    Args:
        arm: with its sensors' noise, steps and dead times.
        input: "pulse" (open loop: 3 A from 0.5 to 1.0 s, then pulses of random size and time), "square" (PD to ±50° at
            0.2 Hz), "sweep" (slow PD motion and tones of random phase in the command), or a recording, or the path of
            one: its commands are played, with its conditions, and it needs no signals. Sizes are for a drive of 5 A and
            scale with the arm's limit.
        duration: [s]; a recording brings its own.
        rate: samples per second [Hz]; a recording brings its own.
        seed: of noise, pulses and phases.
        noise: whether readings get noise and the sensor's steps. A sensor with noise = "auto" gets none, and a note says so.
        name: of the recording; that of the input by default.
        derivatives: names of constants and of parameters of effects, as "hub.inertia", "coulomb.torque". Derivatives are taken
            at the commands as recorded, of the readings without noise and steps, through stick, slip and contact. They hold
            for changes that add and remove no event. The laws of effects are differentiated by narrow differences. Their kernel
            is compiled at the first use, which takes some 90 s; docs/model.md has an example.

    Returns:
        The recording; with `derivatives` also those by constant and signal, {"hub.inertia": {"arm_angle": (n,), …}, …}, in the
        signal's unit over that of the constant.

    Raises:
        InputError: for an input that does not exist or does not fit the arm, a motion beyond any arm's, or a constant by which
            there is no derivative.

    Examples:
        >>> from flexarm_env import Arm, simulate
        >>> square = simulate(Arm.load("thesis"), "square", duration=2.0, rate=100.0, seed=1)
        >>> square
        Recording('square': 200 samples, 1.99 s at 100 Hz, current -> arm_angle, motor_speed, strain_mid, strain_base)

        The same commands on another model, to compare the two:

        >>> sticky = Arm.load("thesis").with_effect("coulomb", torque=0.2)
        >>> again = simulate(sticky, square, noise=False)
        >>> bool((again.command == square.command).all())
        True
    """
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise InputError(f"seed {seed!r}; give a whole number from 0 up")
    if isinstance(input, str) and input in EXPERIMENTS:
        made = _perform(arm, input, _samples(duration, rate), rate, seed, noise, name or input)
    else:
        source = input if isinstance(input, Recording) else _read(input)
        made = _replay(arm, source, seed, noise, name or source.name)
    if noise:
        made = replace(made, notes=_notes(arm))
    return made if derivatives is None else (made, _derivatives(arm, made, derivatives))


def _derivatives(arm: Arm, made: Recording, names: Sequence[str]) -> Derivatives:
    """Differentiate the readings of a recording that the arm made, at its commands."""
    paths = [full_path(arm, name) for name in names]
    carried = with_stated(arm, stated_by(arm, made))
    even, interval = _sampling(made.time)
    rig = Rig(carried, 1.0 / interval, len(made), None)
    tangents = tangents_of(carried, rig.plant, paths)
    found = rig.replay_derivatives(made.command, () if even else (np.diff(made.time),), tangents)
    return {name: {signal: found[:, i, number] for i, signal in enumerate(arm.signals)} for number, name in enumerate(names)}


def _notes(arm: Arm) -> tuple[str, ...]:
    """Name the signals that have no noise because only recordings give it."""
    signals = ", ".join(signal for signal in arm.signals if signal in arm.auto_noise)
    return (f'no noise on {signals}: noise = "auto" holds for recordings; write a number for one here',) if signals else ()


def _perform(arm: Arm, experiment: str, count: int, rate: float, seed: int, noise: bool, name: str) -> Recording:
    """Perform an experiment of `count` samples."""
    rig = Rig(arm, rate, count, _noise(arm, count, seed, experiment) if noise else None)
    plan = plan_of(arm, experiment, np.arange(len(rig.readings)) / rate, seed)
    commands, readings = rig.run(plan)
    reference = None if plan.reference is None else plan.reference[:count]
    return _recording(arm, name, np.arange(count) / rate, commands, readings, reference, {})


def _replay(arm: Arm, source: Recording, seed: int, noise: bool, name: str) -> Recording:
    """Apply the commands of a recording, with what it states of the machine.

    Raises:
        InputError: for another input than the arm's, or a payload that the arm cannot carry, or a value out of bounds.
    """
    if source.input_kind != arm.input:
        raise InputError(f"{source.name}: holds {source.input_kind}, but arm '{arm.name}' is driven by {arm.input}")
    draws = _noise(arm, len(source), seed, source.name) if noise else None
    even, interval = _sampling(source.time)
    check_stated(arm, source)
    rig = Rig(with_stated(arm, stated_by(arm, source)), 1.0 / interval, len(source), draws)
    readings = rig.replay(source.command, () if even else (np.diff(source.time),))
    conditions = {key: value for key, value in source.conditions.items() if key == PAYLOAD or key in arm.conditions}
    return _recording(arm, name, source.time, source.command, readings, source.reference, conditions)


def _recording(
    arm: Arm,
    name: str,
    time: Floats,
    commands: Floats,
    readings: Floats,
    reference: Floats | None,
    conditions: dict[str, float],
) -> Recording:
    """Record readings (n, signals)."""
    check_motion(arm, name, time, commands, readings)
    signals = {signal: readings[:, i] for i, signal in enumerate(arm.signals)}
    return Recording.from_arrays(name, time, arm.input, commands, signals, reference, conditions)


def _samples(duration: float, rate: float) -> int:
    """Count the samples of a duration [s] at a rate [Hz]."""
    if not (np.isfinite(duration) and np.isfinite(rate) and duration > 0.0 and rate > 0.0):
        raise InputError(f"duration {duration:g} s at {rate:g} Hz; give two positive numbers")
    count = duration * rate
    if not 1.5 <= count <= MOST_SAMPLES:
        raise InputError(f"{duration:g} s at {rate:g} Hz make {count:.3g} samples; allowed are 2 to {MOST_SAMPLES}")
    return round(count)


def _sampling(time: Floats) -> tuple[bool, float]:
    """Tell whether samples are even; return that and the interval [s], free of the rounding of the times."""
    steps = np.diff(time)
    median = float(np.median(steps))
    # Narrower than in a diagnosis, which takes jitter below the resolution of its errors for even: only rounding is left out.
    even = bool(np.abs(steps - median).max() <= 1e-6 * median)
    return even, float(f"{time[-1] / len(steps) if even else median:.12g}")


def _read(path: str | os.PathLike[str]) -> Recording:
    """Read commands from a file."""
    if isinstance(path, str) and not Path(path).exists() and not Path(path).suffix:
        raise InputError(f"no input '{path}': neither an experiment nor a file{did_you_mean(path, EXPERIMENTS)}")
    return Recording.read(path, require_signal=False)


def _noise(arm: Arm, count: int, seed: int, experiment: str) -> Floats:
    """Draw the noise of every sensor (count, signals)."""
    draws = [random_stream(seed, experiment, signal).standard_normal(count) * s["noise"] for signal, s in arm.sensors.items()]
    return np.column_stack(draws) if draws else np.zeros((count, 0))
