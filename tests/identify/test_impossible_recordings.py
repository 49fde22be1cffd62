"""Recordings under whose times or commands no arm can be judged: one line, before any search."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, InputError, Recording, compare, diagnose, fit, inspect_recordings, simulate
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.starts import starts_of

ARMS = ("thesis", "cu-rigid", "cu-flexible")
COMMANDS: tuple[Callable[..., object], ...] = (compare, fit, diagnose, inspect_recordings)


def stretched(recording: Recording, factor: float) -> Recording:
    return replace(recording, time=recording.time * factor)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("command", COMMANDS)
def test_milliseconds_under_seconds_are_refused(name, command):
    arm = Arm.load(name)
    run = simulate(arm, "square", duration=1.0, rate=200.0, name="run")
    with pytest.raises(InputError, match=r"run: samples are 5 s apart.*is the unit of time right") as caught:
        command(arm, [stretched(run, 1000.0)])
    assert str(caught.value).isprintable()


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("command", COMMANDS)
def test_commands_beyond_any_motion_are_refused(name, command):
    arm = Arm.load(name)
    run = simulate(arm, "square", duration=1.0, rate=200.0, name="run")
    absurd = replace(run, command=np.full(len(run), 9e6))
    with pytest.raises(InputError, match=r"run: .* leaves ±1e\+07 .* commands of up to 9e\+06") as caught:
        command(arm, [absurd])
    assert str(caught.value).isprintable()


def test_slow_samples_and_commands_in_milliamperes_are_still_judged():
    arm = Arm.load("thesis")
    run = simulate(arm, "square", duration=4.0, rate=200.0)
    assert np.isfinite(compare(arm, [stretched(run, 100.0)]).error)
    faults = inspect_recordings(arm, [replace(run, command=1000.0 * run.command)]).faults
    assert [(fault.kind, fault.signal) for fault in faults] == [("factor", "current")]


def test_an_arm_that_does_not_stay_finite_is_named():
    arm = Arm.load("thesis-fem").with_effect("asymmetric_viscous", coefficient=1e5)
    run = simulate(Arm.load("thesis-fem"), "pulse", duration=1.0, rate=200.0)
    with pytest.raises(InputError, match=r"effects\.asymmetric_viscous\.coefficient = 100000"):
        compare(arm, [run])


@pytest.mark.parametrize("kind", ["current", "voltage", "position"])
def test_a_command_of_another_kind_is_named_as_it_is(kind):
    arm = Arm.load("dfki-pendulum")
    run = Recording("run", np.arange(20) / 100.0, kind, np.zeros(20), {"arm_angle": np.zeros(20)})
    with pytest.raises(InputError, match=f"run holds {kind}, but arm 'dfki-pendulum' is driven by torque; correct drive.input"):
        compare(arm, [run])


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("command", COMMANDS)
def test_noise_below_the_rounding_of_readings_is_refused(name, command):
    arm = Arm.load(name)
    run = simulate(arm, "square", duration=1.0, rate=200.0, name="run")
    fine = arm.with_values({"sensors.arm_angle.noise": 1e-300, "sensors.arm_angle.resolution": 0.0})
    with pytest.raises(InputError, match=r"sensors.arm_angle.noise = 1e-300 is below the rounding of readings in run") as caught:
        command(fine, [run])
    assert str(caught.value).isprintable()


def test_noise_beyond_any_offset_leaves_starts_within_bounds():
    arm = Arm.load("cu-rigid").with_values({"sensors.arm_angle.noise": 1e6})
    run = simulate(Arm.load("cu-rigid"), "square", duration=1.0, rate=200.0, name="run")
    nominal, dataset = prepare(arm, [run])
    offsets = [start["arm_angle"] for start in starts_of(nominal, "sensor_offset", dataset)]
    assert max(offsets) == nominal.known["sensor_offset"].parameters["arm_angle"].high
    for start in starts_of(nominal, "sensor_offset", dataset):
        nominal.with_effect("sensor_offset", **start)
