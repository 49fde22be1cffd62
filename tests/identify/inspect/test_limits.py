"""Readings at a rail and commands beyond a limit: each named with its signal, size, rows and the line that mends it."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, inspect_recordings, simulate
from tests.identify.inspect.faulty import changed, only


def test_a_clipped_gage_stands_at_its_extreme(thesis, square):
    clipped = np.clip(square.signals["strain_base"], -1.5, 1.5)
    fault = only(thesis, changed(square, "strain_base", clipped))
    share = np.mean(np.abs(clipped) == 1.5)
    assert (fault.kind, fault.signal, fault.value, fault.unit) == ("rail", "strain_base", 1.5, "V")
    assert fault.share == pytest.approx(share)
    assert f"{100 * share:.0f} % of the rows" in fault.message
    assert tomllib.loads(fault.hint) == {"strain_base": {"range": ["-1.5 V", "1.5 V"]}}


@pytest.mark.parametrize("signal", ["arm_angle", "motor_speed", "strain_mid", "strain_base"])
@pytest.mark.parametrize("end", [-1.0, 1.0])
def test_one_rail_is_found_on_its_side(thesis, square, signal, end):
    values = end * square.signals[signal]
    level = float(np.quantile(values, 0.92))
    fault = only(thesis, changed(square, signal, end * np.minimum(values, level)))
    assert (fault.kind, fault.signal, fault.value) == ("rail", signal, pytest.approx(end * level))
    low, high = (float(text.split()[0]) for text in tomllib.loads(fault.hint)[signal]["range"])
    readings = end * np.minimum(values, level)
    left_out = (readings <= low) | (readings >= high)
    assert left_out.mean() == pytest.approx(fault.share)


def test_an_encoder_at_rest_at_its_largest_angle_is_no_rail():
    """Without noise, in steps of 1 mrad: its reading stands for a second, and so does the hub."""
    time = np.arange(0.0, 4.0, 0.002)
    angle = np.where(time < 1.0, 1.0 - np.cos(np.pi * time), 2.0)
    angle = np.where(time > 3.0, 1.0 + np.cos(np.pi * (time - 3.0)), angle)
    coarse = np.round(angle, 3)
    arm = Arm.load("cu-rigid")
    run = Recording.from_arrays("run", time, "voltage", np.sin(time), {"arm_angle": coarse})
    assert inspect_recordings(arm, [run]).faults == ()


@pytest.mark.parametrize("seed", range(4))
def test_a_last_digit_that_flickers_at_rest_is_no_rail(seed):
    """A link that is held at its largest angle, then at its smallest, by an encoder whose noise is a quarter of a step."""
    time = np.arange(0.0, 8.0, 0.01)
    angle = 256.7 * np.clip(1.6 * np.sin(np.pi * (time - 0.25) / 4.0) + 0.2 * np.sin(7.0 * time) * (time < 1.0), -1.0, 1.0)
    slow = np.convolve(angle, np.full(60, 1 / 60), mode="same")  # so that it comes to rest and does not run into an end
    noisy = slow + 0.25 * np.random.default_rng(seed).standard_normal(len(time))
    reading = np.round(noisy) * 0.001
    run = Recording.from_arrays("run", time, "voltage", np.sin(time), {"arm_angle": reading})
    assert [one for one in inspect_recordings(Arm.load("cu-rigid"), [run]).faults if one.kind == "rail"] == []


@pytest.mark.parametrize("seed", range(4))
def test_a_fine_encoder_whose_hub_slows_down_to_its_largest_angle_is_no_rail(seed):
    """Friction stops it there for 80 ms. In steps of 1e-6 rad even the last samples before are many steps apart."""
    time = np.arange(0.0, 3.0, 0.001)
    sets_out, slows, leaves = np.maximum(time - 0.9, 0.0), np.minimum(time - 1.5, 0.0), np.maximum(time - 1.58, 0.0)
    angle = np.where(time < 1.2, 0.0400005 + 2.0 * sets_out**2, 0.39999975 - 2.0 * slows**2 - 5.0 * leaves**2)
    reading = np.round(angle / 1e-6 + 0.2 * np.random.default_rng(seed).standard_normal(len(time))) * 1e-6
    run = Recording.from_arrays("run", time, "voltage", np.sin(time), {"arm_angle": reading})
    assert [one for one in inspect_recordings(Arm.load("cu-rigid"), [run]).faults if one.kind == "rail"] == []


def test_a_motor_that_only_turns_forward_rests_at_zero_and_not_at_a_rail():
    time = np.arange(0.0, 4.0, 0.002)
    speed = np.round(np.maximum(20.0 * np.sin(2.0 * time), 0.0))
    angle = np.cumsum(speed) * 0.002 / 48.4
    run = Recording.from_arrays("run", time, "voltage", np.sin(time), {"arm_angle": angle, "motor_speed": speed})
    assert inspect_recordings(Arm.load("cu-rigid"), [run]).faults == ()


def test_a_lone_angle_that_leaves_zero_at_a_slope_rests_there_and_is_at_no_rail():
    """No other signal says that the hub rests; zero does."""
    time = np.arange(0.0, 8.0, 0.01)
    angle = np.round(np.maximum(np.sin(np.pi * time / 2.0), 0.0), 3)
    run = Recording.from_arrays("run", time, "voltage", np.sin(time), {"arm_angle": angle})
    arm = Arm.load("cu-rigid")
    assert [one for one in inspect_recordings(arm, [run]).faults if one.kind == "rail"] == []
    lifted = Recording.from_arrays("run", time, "voltage", np.sin(time), {"arm_angle": angle + 0.1})
    assert "rail" in [one.kind for one in inspect_recordings(arm, [lifted]).faults]


def test_what_a_rail_leaves_of_a_noisy_reading_is_not_lost(thesis, square):
    """Between the readings at the rail, which are none, the others come one by one and repeat by chance."""
    step = 0.002
    coarse = np.round(square.signals["arm_angle"] / step) * step
    level = float(np.quantile(coarse, 0.85))
    found = inspect_recordings(thesis, [changed(square, "arm_angle", np.minimum(coarse, level))]).faults
    assert [(one.kind, one.value) for one in found] == [("rail", pytest.approx(level))]


def test_commands_beyond_the_limit_are_named(thesis, square):
    """The amplifier gives 5 A at most, and the file has the commands that it was given."""
    cut = thesis.with_effect("saturation", limit=5.0)
    commands = replace(square, command=7.5 / np.abs(square.command).max() * square.command)
    recording = simulate(cut, commands, seed=1)
    fault = only(thesis, recording)
    assert (fault.kind, fault.signal, fault.value) == ("limit", "current", pytest.approx(1.5))
    assert tomllib.loads(fault.hint) == {"effects": {"saturation": {"limit": 5.0}}}
    assert inspect_recordings(cut, [recording]).faults == ()


def test_commands_in_another_unit_are_not_beyond_the_limit(thesis, square):
    fault = only(thesis, replace(square, command=1000.0 * square.command))
    assert (fault.kind, fault.signal, fault.value) == ("factor", "current", pytest.approx(1000.0, rel=0.02))
    assert tomllib.loads(fault.hint) == {"current": {"unit": "mA"}}
