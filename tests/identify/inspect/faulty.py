"""Recordings into which a fault of a sensor, a unit or a clock is put."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from flexarm_env import Arm, Recording, inspect_recordings, simulate
from flexarm_env.identify.inspect.fault import KINDS
from flexarm_env.identify.inspect.motion import motion_faults

#: Largest relative error of a factor or a lag.
CLOSE = 0.02
ARMS = ("thesis", "thesis-fem", "cu-rigid", "cu-flexible", "emps")


@cache
def sound(arm: str = "thesis", experiment: str = "square") -> Recording:
    return simulate(Arm.load(arm), experiment, duration=6.0, seed=1)


def with_signal(recording: Recording, signal: str, change: Callable[[np.ndarray], np.ndarray]) -> Recording:
    if signal == recording.input_kind:
        return replace(recording, command=change(recording.command))
    return replace(recording, signals={**recording.signals, signal: change(recording.signals[signal])})


def late(recording: Recording, seconds: float, signals: tuple[str, ...]) -> Recording:
    """Make signals late by a whole number of samples; before, they stay at their first reading."""
    count = round(seconds / recording.sample_time)
    for signal in signals:
        recording = with_signal(recording, signal, lambda values: np.concatenate([np.full(count, values[0]), values[:-count]]))
    return recording


def found_in(arm: str, recording: Recording):
    (fault,) = motion_faults(Arm.load(arm), [recording])
    return fault


def changed(recording: Recording, signal: str, values) -> Recording:
    """A recording with other readings of a signal."""
    return replace(recording, signals=recording.signals | {signal: np.asarray(values, dtype=float)})


def only(arm: Arm, recording: Recording):
    """The one fault of a recording, whose line of an arm file is TOML."""
    (fault,) = inspect_recordings(arm, [recording]).faults
    assert fault.kind in KINDS
    assert tomllib.loads(fault.hint) if fault.hint else True
    return fault
