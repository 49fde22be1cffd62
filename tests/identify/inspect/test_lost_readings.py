"""Readings that were lost, repeat, stand still or leap: each named with its signal, size and rows."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, inspect_recordings, simulate
from flexarm_env.identify.inspect.frozen import frozen
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.inspect.spike import spike
from flexarm_env.identify.settings import SETTINGS
from tests.identify.inspect.faulty import changed, only


def test_an_unplugged_gage_never_moves(thesis, square):
    fault = only(thesis, changed(square, "strain_base", np.full(len(square), 0.02)))
    assert (fault.kind, fault.signal, fault.value) == ("constant", "strain_base", 0.02)
    assert "never moves" in fault.message


@pytest.mark.parametrize("count", [2, 3, 10, 25])
def test_a_slow_sensor_repeats(thesis, square, count):
    held = square.signals["strain_mid"][np.arange(len(square)) // count * count]
    fault = only(thesis, changed(square, "strain_mid", held))
    assert (fault.kind, fault.signal) == ("held", "strain_mid")
    assert fault.value == pytest.approx(count, rel=0.002)
    assert tomllib.loads(fault.hint) == {"strain_mid": {"repeats": count}}


def test_a_sensor_at_60_hz_in_a_file_of_500_hz_repeats_by_fractions(thesis, square):
    latest = (np.floor(square.time * 60.0 + 1e-9) / 60.0 * 500.0 + 0.5).astype(int)
    fault = only(thesis, changed(square, "arm_angle", square.signals["arm_angle"][latest]))
    assert (fault.kind, fault.value) == ("held", pytest.approx(500 / 60, rel=0.01))


def test_a_coarse_encoder_at_a_steady_speed_is_not_held():
    """It changes every eighth row, by one step: no slower sensor is needed."""
    time = np.arange(0.0, 4.0, 0.002)
    angle = np.round(0.0625 * time / 1e-3) * 1e-3
    run = Recording.from_arrays("run", time, "voltage", np.ones_like(time), {"arm_angle": angle})
    assert inspect_recordings(Arm.load("cu-rigid"), [run]).faults == ()


def test_ten_zeros_in_the_angle_are_a_dropout_with_its_rows(thesis, square):
    angle = square.signals["arm_angle"].copy()
    assert np.abs(angle[1200:1210]).min() > 0.5
    angle[1200:1210] = 0.0
    fault = only(thesis, changed(square, "arm_angle", angle))
    assert (fault.kind, fault.signal, fault.value) == ("dropout", "arm_angle", 0.0)
    assert fault.rows == tuple(range(1200, 1210))
    assert "samples 1201 to 1210" in fault.message
    ((start, stop),) = tomllib.loads(fault.hint)["arm_angle"]["ignore"]
    left_out = np.flatnonzero((square.time >= start) & (square.time < stop))
    assert left_out.tolist() == list(range(1200, 1210))


def test_a_single_zero_is_a_dropout_and_another_single_reading_a_spike(thesis, square):
    angle = square.signals["arm_angle"].copy()
    angle[1200] = 0.0
    assert only(thesis, changed(square, "arm_angle", angle)).kind == "dropout"
    angle = square.signals["arm_angle"].copy()
    angle[1200] += 0.7
    fault = only(thesis, changed(square, "arm_angle", angle))
    assert (fault.kind, fault.rows, fault.value) == ("spike", (1200,), pytest.approx(0.7, abs=0.01))


@pytest.mark.parametrize(("late", "found"), [(0, 1), (1, 0), (2, 0), (5, 1)])
def test_a_leap_after_a_jump_of_the_command_is_no_spike(thesis, square, late, found):
    """One in the same sample may be what a controller answers."""
    command, speed = square.command.copy(), square.signals["motor_speed"].copy()
    command[1200:] += 40.0 * np.abs(np.diff(command)).max()
    speed[1200 + late] += 10.0 * np.abs(np.diff(speed)).max()
    run = replace(changed(square, "motor_speed", speed), command=command)
    assert len(spike(Inspected.of(run), thesis, SETTINGS.inspecting)) == found


def test_spikes_are_named_by_their_largest(thesis, square):
    strain = square.signals["strain_base"].copy()
    strain[[300, 1500, 2400]] += [6.0, -20.0, 9.0]
    fault = only(thesis, changed(square, "strain_base", strain))
    assert (fault.kind, fault.rows, fault.value) == ("spike", (300, 1500, 2400), pytest.approx(20.0, rel=0.02))
    assert "samples 301, 1501, 2401" in fault.message
    assert len(tomllib.loads(fault.hint)["strain_base"]["ignore"]) == 3


def test_small_spikes_in_a_fast_motion_are_found_beside_smaller_ones():
    """The angle of an axis at a steady speed changes as much from row to row as its spikes are a few times high."""
    emps = Arm.load("emps")
    run = simulate(emps, "square", duration=4.0, rate=400.0, seed=5)
    angle = run.signals["arm_angle"].copy()
    largest = float(np.abs(np.diff(angle)).max())
    angle[[300, 700, 1200]] += largest * np.array([4.5, -4.3, 2.0])
    fault = only(emps, changed(run, "arm_angle", angle))
    assert (fault.kind, fault.value) == ("spike", pytest.approx(4.5 * largest, rel=0.02))
    assert {300, 700} <= set(fault.rows)


def test_readings_that_were_not_measured_are_left_out(thesis, square):
    angle = square.signals["arm_angle"].copy()
    angle[::2] = np.nan
    angle[1201:1221] = 0.0
    fault = only(thesis, changed(square, "arm_angle", angle))
    assert (fault.kind, fault.rows[0]) == ("dropout", 1201)


@pytest.mark.parametrize(("signal", "length"), [("arm_angle", 60), ("strain_base", 25)])
def test_a_noisy_reading_that_stands_still_is_lost(thesis, square, signal, length):
    values = square.signals[signal].copy()
    values[1000 : 1000 + length] = values[1000]
    fault = only(thesis, changed(square, signal, values))
    assert (fault.kind, fault.signal, fault.value) == ("dropout", signal, values[1000])
    assert set(range(1000, 1000 + length)) <= set(fault.rows)
    assert "stands still" in fault.message


@pytest.mark.parametrize(("noise", "found"), [(0.0, 0), (1.0, 1)])
def test_an_encoder_without_noise_may_rest_beside_a_noisy_tachometer(thesis, noise, found):
    """It turns back often where a fast vibration shakes the hub, and does not where the hub rests."""
    draw, time, step = np.random.default_rng(1), np.arange(1250) / 125.0, 9e-4
    moves = time > 1.0
    angle = moves * (0.5 * np.sin(time - 1.0) + 2.0 * step * np.sin(250.0 * time))
    angle = step * np.round(angle / step + noise * moves * draw.standard_normal(len(time)))
    speed = 50.0 * moves * np.gradient(angle, time) + 2.5 * draw.standard_normal(len(time))
    run = Recording.from_arrays("rest", time, "current", np.sin(time), {"arm_angle": angle, "motor_speed": speed})
    assert len(frozen(Inspected.of(run), thesis, SETTINGS.inspecting)) == found


def test_a_hub_that_is_stuck_while_the_beam_rings_is_sound(thesis, square):
    """Encoder and tachometer without noise stand still together."""
    signals = square.signals | {"arm_angle": np.zeros(len(square)), "motor_speed": np.zeros(len(square))}
    assert inspect_recordings(thesis, [replace(square, signals=signals)]).faults == ()


def test_two_stretches_that_stand_still_are_left_out_in_their_order(thesis, square):
    values = square.signals["arm_angle"].copy()
    rows = np.arange(len(values))
    moving = np.flatnonzero(np.abs(square.signals["motor_speed"]) > 2.0)
    first, last = moving[0] + 20, moving[moving > moving[0] + 400][0] + 20
    values[first : first + 30], values[last : last + 60] = values[first], values[last]
    found = [one for one in inspect_recordings(thesis, [changed(square, "arm_angle", values)]).faults if one.kind == "dropout"]
    assert found
    for one in found:
        assert list(one.rows) == sorted(one.rows)
        stretches = tomllib.loads(one.hint)["arm_angle"]["ignore"]
        assert all(start < end for start, end in stretches)
        assert set(one.rows) <= {*rows[first : first + 30], *rows[last : last + 60]}
