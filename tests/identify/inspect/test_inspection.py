"""Faults of signals that the readings alone show: each named with its signal, size, rows and the line that mends it."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest

import flexarm_env.demo
from flexarm_env import Arm, Recording, inspect_recordings, simulate
from flexarm_env.identify.inspect.fault import KINDS
from flexarm_env.identify.inspect.frozen import frozen
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.inspect.spike import spike
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.terminal.inputs import read_recordings


def changed(recording: Recording, signal: str, values) -> Recording:
    return replace(recording, signals=recording.signals | {signal: np.asarray(values, dtype=float)})


def only(arm: Arm, recording: Recording):
    """The one fault of a recording."""
    (fault,) = inspect_recordings(arm, [recording]).faults
    assert fault.kind in KINDS
    assert tomllib.loads(fault.hint) if fault.hint else True
    return fault


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


@pytest.mark.parametrize("pause", [0.002, 0.5])
def test_two_runs_in_one_file(thesis, pulse, square, pause):
    start = pulse.duration + pause
    signals = {name: np.r_[values, square.signals[name]] for name, values in pulse.signals.items()}
    time, command = np.r_[pulse.time, start + square.time], np.r_[pulse.command, square.command]
    fault = only(thesis, Recording.from_arrays("both", time, "current", command, signals))
    assert (fault.kind, fault.signal, fault.rows) == ("glued", "", (len(pulse),))
    assert fault.value == pytest.approx(start)
    assert "cut it there" in fault.message


def test_runs_that_end_a_turn_apart_are_two_and_no_wrap():
    arm = Arm.load("cu-rigid")
    time = np.arange(0.0, 2.0, 0.004)
    noise = np.random.default_rng(1).normal(0.0, 5e-4, 2 * len(time))
    angle = 0.5 * 6.2 * (1.0 - np.cos(np.pi * np.minimum(time, 1.0)))
    both = np.r_[angle, 0.3 * angle] + noise
    command = np.tile(np.sin(np.pi * time), 2)
    run = Recording.from_arrays("both", np.arange(len(both)) * 0.004, "voltage", command, {"arm_angle": both})
    fault = next(one for one in inspect_recordings(arm, [run]).faults)
    assert (fault.kind, fault.rows) == ("glued", (len(time),))


def test_an_angle_whose_encoder_slips_is_not_two_runs(thesis, square):
    """One signal jumps, while the others go on in motion."""
    row = int(np.abs(square.signals["motor_speed"]).argmax())
    angle = square.signals["arm_angle"] + np.where(np.arange(len(square)) >= row, 0.3, 0.0)
    assert [fault.kind for fault in inspect_recordings(thesis, [changed(square, "arm_angle", angle)]).faults] == []


def test_every_fault_becomes_plain_data(thesis, square):
    clipped = changed(square, "strain_base", np.clip(square.signals["strain_base"], -1.5, 1.5))
    (plain,) = [fault.as_json() for fault in inspect_recordings(thesis, [clipped]).faults]
    expected = {"file": "square", "signal": "strain_base", "fault": "rail", "value": 1.5, "unit": "V"}
    assert expected.items() <= plain.items()
    assert len(plain["samples"]) <= 100


def test_readings_that_were_not_measured_are_left_out(thesis, square):
    angle = square.signals["arm_angle"].copy()
    angle[::2] = np.nan
    angle[1201:1221] = 0.0
    fault = only(thesis, changed(square, "arm_angle", angle))
    assert (fault.kind, fault.rows[0]) == ("dropout", 1201)


@pytest.mark.parametrize("name", ["thesis", "thesis-fem", "cu-flexible", "cu-rigid", "emps"])
@pytest.mark.parametrize("experiment", ["pulse", "square", "sweep"])
@pytest.mark.parametrize("noise", [True, False])
def test_a_simulated_machine_is_sound(name, experiment, noise):
    arm = Arm.load(name)
    run = simulate(arm, experiment, duration=4.0, rate=300.0, seed=8, noise=noise)
    assert inspect_recordings(arm, [run]).faults == ()


def test_the_shipped_recordings_are_sound():
    folder = flexarm_env.demo.__path__[0]
    found = inspect_recordings(Arm.load("thesis-fem"), Recording.read_all(folder))
    assert found.faults == ()
    assert {one.signal for one in found.signals} == {"arm_angle", "motor_speed", "strain_mid", "strain_base"}


@pytest.mark.parametrize(
    ("arm", "pattern"),
    [
        ("emps", "emps/*.mat"),
        ("cu-flexible", "cu_boulder/*flexarm*.txt"),
        ("cu-rigid", "cu_boulder/*rigidarm*.txt"),
        *(("thesis-fem", f"practice/p{i:02d}/*.csv") for i in range(1, 11)),
    ],
)
def test_measured_recordings_are_sound(measurements, arm, pattern):
    model = Arm.load(arm)
    files = sorted(measurements.glob(pattern))
    assert files
    assert inspect_recordings(model, read_recordings(model, files, None)).faults == ()


def test_a_gap_in_a_motion_is_not_two_runs(thesis, square):
    """A logger that lost half a second while the arm moved: every signal has changed meanwhile."""
    start = int(np.abs(square.signals["motor_speed"]).argmax())
    kept = np.r_[np.arange(start), np.arange(start + 250, len(square))]
    signals = {name: values[kept] for name, values in square.signals.items()}
    run = Recording.from_arrays("gap", square.time[kept], "current", square.command[kept], signals)
    assert inspect_recordings(thesis, [run]).faults == ()
    absent = {name: np.where(np.isin(np.arange(len(square)), kept), values, np.nan) for name, values in square.signals.items()}
    assert inspect_recordings(thesis, [replace(square, signals=absent)]).faults == ()


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
