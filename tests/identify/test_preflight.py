"""Whether recordings move an arm at all, before anything is calibrated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env.arm import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.diagnose import diagnose
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.preflight import Preflight, preflight
from flexarm_env.recordings.recording import Recording

HELD = "which explains a release or a single step alone"


def at_rest(arm: Arm, samples: int, command: float = 0.0, **offsets: float) -> Recording:
    """Record an arm that stands still for some samples at 500 Hz, under one command: noise, and offsets of its sensors."""
    random = np.random.default_rng(0)
    noise = {signal: random.normal(0.0, values["noise"], samples) for signal, values in arm.sensors.items()}
    signals = {signal: readings + offsets.get(signal, 0.0) for signal, readings in noise.items()}
    return Recording.from_arrays("rest", 0.002 * np.arange(samples), arm.input, np.full(samples, command), signals)


def checked(arm: Arm, *recordings: Recording) -> Preflight:
    return preflight(prepare(arm, recordings)[1])


@pytest.mark.parametrize("command", [0.0, 0.05])
@pytest.mark.parametrize("name", ["thesis", "cu-flexible", "emps"])
def test_noise_is_no_motion_in_however_many_samples(name, command):
    arm = Arm.load(name)
    for samples in (1000, 100_000):
        assert checked(arm, at_rest(arm, samples, command)).too_still


def test_noise_above_the_stated_one_is_no_motion():
    arm = Arm.load("thesis")
    quiet = arm.with_values(
        {
            f"sensors.{signal}.{key}": values[key] / 30
            for signal, values in arm.sensors.items()
            for key in values
            if key == "noise"
        }
    )
    assert checked(quiet, at_rest(arm, 3000)).too_still


def test_a_tachometer_s_offset_is_motion_only_where_no_angle_shows_the_rest():
    arm = Arm.load("thesis")
    rest = at_rest(arm, 3000, motor_speed=1.0)
    assert checked(arm, rest).too_still
    alone = replace(rest, signals={"motor_speed": rest.signals["motor_speed"]})
    assert not checked(arm, alone).too_still


def test_a_pendulum_that_swings_by_itself_moves():
    arm = Arm.load("multiarm-pendulum").with_values({"link.hangs_at": np.pi / 2})  # let go beside the place where it hangs
    swing = simulate(arm, at_rest(arm, 1000), rate=500.0)
    found = checked(arm, swing)
    assert not found.too_still
    assert any(HELD in note for note in found.notes)


def test_one_recording_that_moves_is_enough():
    arm = Arm.load("thesis")
    assert not checked(arm, at_rest(arm, 1000), simulate(arm, "pulse", duration=2.0, rate=500.0)).too_still


def test_a_constant_command_is_one_after_thinning_too():
    arm = Arm.load("cu-rigid")
    turning = simulate(arm, at_rest(arm, 1000, 0.2), rate=500.0)
    notes = checked(arm, turning).notes
    assert any("thinned" in note for note in notes)
    assert any(f"the command is 0.2 in every row, {HELD}" in note for note in notes)


def test_a_long_rest_is_told_at_once():
    arm = Arm.load("thesis")
    found = diagnose(arm, [at_rest(arm, 30_000)], jobs=1)
    assert found.verdict == "insufficient_data"
    assert found.trace == []
    assert "nothing moves beyond the noise" in found.notes[-1]
