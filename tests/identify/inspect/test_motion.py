"""Faults that the model's motion shows: the injected one is found, with its size; a sound recording has none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate
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


@pytest.mark.parametrize("experiment", ["pulse", "square", "sweep"])
@pytest.mark.parametrize("arm", ARMS)
def test_a_sound_recording_has_no_fault(arm, experiment):
    assert motion_faults(Arm.load(arm), [sound(arm, experiment)]) == []


@pytest.mark.parametrize(
    ("signal", "factor", "hint"),
    [
        ("motor_speed", 1 / (2 * math.pi), 'motor_speed = { unit = "rps" }'),
        ("motor_speed", 1 / 5, "motor_speed = { scale ="),
        ("motor_speed", 60 / (2 * math.pi), 'motor_speed = { unit = "rpm" }'),
        ("motor_speed", 1 / 1.5, "motor_speed = { scale ="),
        ("arm_angle", 1 / 4, "arm_angle = { scale ="),
        ("arm_angle", 180 / math.pi, 'arm_angle = { unit = "deg" }'),
        ("strain_base", 2.0, "strain_base = { scale ="),
        ("current", 2.0, "current = { scale ="),
        ("current", 1000.0, 'current = { unit = "mA" }'),
    ],
)
def test_a_factor_is_found_with_its_size(signal, factor, hint):
    fault = found_in("thesis", with_signal(sound(), signal, lambda values: factor * values))
    assert (fault.kind, fault.signal) == ("factor", signal)
    assert fault.value == pytest.approx(factor, rel=CLOSE)
    assert fault.hint.startswith(hint)


@pytest.mark.parametrize("signal", ["arm_angle", "motor_speed", "strain_base", "strain_mid", "current"])
def test_a_signal_against_the_model_is_found(signal):
    fault = found_in("thesis", with_signal(sound(), signal, lambda values: -values))
    assert (fault.kind, fault.signal, fault.value) == ("sign", signal, -1.0)
    assert fault.hint == f"{signal} = {{ sign = -1 }}"


@pytest.mark.parametrize("pair", [("strain_mid", "strain_base"), ("arm_angle", "motor_speed")])
def test_exchanged_signals_are_found(pair):
    signals = sound().signals
    exchanged = replace(sound(), signals={**signals, pair[0]: signals[pair[1]], pair[1]: signals[pair[0]]})
    fault = found_in("thesis", exchanged)
    assert fault.kind == "swapped"
    assert {fault.signal, fault.other} == set(pair)


def test_sensors_late_against_the_command_are_found():
    fault = found_in("thesis", late(sound(), 0.5, tuple(sound().signals)))
    assert (fault.kind, fault.signal) == ("clock", "")
    assert fault.value == pytest.approx(0.5, rel=CLOSE)
    assert fault.hint == 'time = { shift = "0.5 s" }'


@pytest.mark.parametrize("signal", ["arm_angle", "motor_speed", "strain_base"])
def test_one_late_sensor_is_found(signal):
    fault = found_in("thesis", late(sound(), 0.2, (signal,)))
    assert (fault.kind, fault.signal) == ("clock", signal)
    assert fault.value == pytest.approx(0.2, rel=CLOSE)


def test_a_delay_of_the_size_of_an_effect_is_no_fault():
    arm = Arm.load("thesis").with_effect("input_delay", delay=0.02)
    assert motion_faults(Arm.load("thesis"), [simulate(arm, "square", duration=6.0, seed=1)]) == []
