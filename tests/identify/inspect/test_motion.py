"""Faults that the model's motion shows: the injected one is found, with its size; a sound recording has none."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.inspect import command_factor
from flexarm_env.identify.inspect.evidence import gather
from flexarm_env.identify.inspect.motion import motion_faults
from flexarm_env.identify.settings import SETTINGS
from tests.identify.inspect.faulty import ARMS, CLOSE, found_in, late, sound, with_signal


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


@pytest.mark.parametrize(("factor", "unit"), [(1000.0, "mV"), (2.0, "")])
def test_a_factor_of_the_voltage_is_found(factor, unit):
    fault = found_in("cu-rigid", with_signal(sound("cu-rigid"), "voltage", lambda values: factor * values))
    assert (fault.kind, fault.signal) == ("factor", "voltage")
    assert fault.value == pytest.approx(factor, rel=CLOSE)
    assert (f'unit = "{unit}"' in fault.hint) == bool(unit)


@pytest.mark.parametrize("factor", [0.25, 180 / math.pi])
def test_with_one_signal_the_fault_names_the_command_as_well(factor):
    fault = found_in("emps", with_signal(sound("emps"), "arm_angle", lambda values: factor * values))
    assert (fault.kind, fault.signal, fault.other) == ("factor", "arm_angle", "current")
    assert fault.value == pytest.approx(factor, rel=CLOSE)
    assert "current" in fault.message


def test_two_faults_of_one_recording_are_both_found():
    faulty = with_signal(sound(), "motor_speed", lambda values: values / (2 * math.pi))
    faulty = with_signal(faulty, "strain_base", lambda values: 2 * values)
    found = {fault.signal: fault.value for fault in motion_faults(Arm.load("thesis"), [faulty])}
    assert found == {
        "motor_speed": pytest.approx(1 / (2 * math.pi), rel=CLOSE),
        "strain_base": pytest.approx(2.0, rel=CLOSE),
    }


def test_a_recording_that_starts_in_motion_has_its_fault_alone():
    moving = sound().part(0.3)
    assert motion_faults(Arm.load("thesis"), [moving]) == []
    fault = found_in("thesis", with_signal(moving, "motor_speed", lambda values: values / 5))
    assert fault.value == pytest.approx(1 / 5, rel=CLOSE)


@pytest.mark.parametrize("factor", [0.8, 1.2])
def test_a_gain_near_1_belongs_to_the_calibration(factor):
    arm = Arm.load("thesis")
    stronger = arm.with_values({"drive.torque_constant": factor * arm.value("drive.torque_constant")})
    assert motion_faults(arm, [simulate(stronger, "square", duration=6.0, seed=1)]) == []


@pytest.mark.parametrize(
    ("effect", "size"),
    [
        ("coulomb", {"torque": 0.5}),
        ("backlash", {"gap": 0.1}),
        ("tach_filter", {"time": 0.05}),
        ("dead_zone", {"width": 0.5}),
        ("payload", {"mass": 0.1}),
        ("current_lag", {"time": 0.03}),
        ("tach_ripple", {}),
        ("cable_stiffness", {}),
    ],
)
def test_a_missing_effect_is_no_fault(effect, size):
    arm = Arm.load("thesis")
    machine = arm.with_effect(effect, **size)
    assert motion_faults(arm, [simulate(machine, "square", duration=6.0, seed=1)]) == []


@pytest.fixture(scope="module")
def practice(measurements) -> list[Recording]:
    return Recording.read_all(sorted((measurements / "practice").glob("p*/*.csv")))


def test_recordings_of_an_independent_simulator_have_no_fault(practice):
    assert len(practice) == 30
    assert motion_faults(Arm.load("thesis-fem"), practice) == []


@pytest.mark.parametrize(
    ("arm", "files"),
    [("cu-rigid", "cu_boulder/*rigid*"), ("cu-flexible", "cu_boulder/*flexarm*"), ("emps", "emps/*.mat")],
)
def test_recordings_of_real_machines_have_no_fault(measurements, arm, files):
    model = Arm.load(arm)
    recordings = Recording.read_all(sorted(measurements.glob(files)), model.columns)
    assert recordings
    assert motion_faults(model, recordings) == []


@pytest.mark.parametrize("factor", [1 / (2 * math.pi), 1 / 5, 60 / (2 * math.pi)])
def test_a_factor_is_found_beside_effects_that_the_model_lacks(practice, factor):
    faulty = [with_signal(recording, "motor_speed", lambda values: factor * values) for recording in practice]
    found = motion_faults(Arm.load("thesis-fem"), faulty)
    assert {(fault.signal, fault.kind) for fault in found} == {("motor_speed", "factor")}
    # the play and the tachometer's lag of two machines change the ratio of speed and angle
    within = [abs(fault.value / factor - 1.0) < CLOSE for fault in found]
    assert sum(within) >= 24


@pytest.mark.parametrize("offset", [0.006, 0.012, -0.01])
def test_a_loop_that_an_offset_of_the_clock_makes_ring_is_no_fault(offset):
    machine = Arm.load("thesis").with_effect("time_offset", offset=offset)
    assert motion_faults(Arm.load("thesis"), [simulate(machine, "square", duration=6.0, seed=1)]) == []


@pytest.mark.parametrize("lag", [0.06, 0.12])
def test_an_angle_that_is_a_little_late_is_found(lag):
    fault = found_in("thesis", late(sound(experiment="pulse"), lag, ("arm_angle",)))
    assert (fault.kind, fault.signal) == ("clock", "arm_angle")
    assert fault.value == pytest.approx(lag, rel=CLOSE)


def test_the_noise_of_all_signals_counts_from_whichever_the_start_is_read():
    part = with_signal(sound().part(0.3), "motor_speed", lambda speed: speed / 5.0)
    run = gather(Arm.load("thesis"), part, SETTINGS).run
    assert np.isfinite(run.noise).all()


@pytest.mark.parametrize("size", [0.02, 0.7, 1.4, 60.0])
@pytest.mark.parametrize("power", [0.8, 1.0, 1.2])
@pytest.mark.parametrize("best", [0.985, 1.0, 1.015])
def test_the_search_for_a_command_s_factor_ends_at_the_best_from_either_side(monkeypatch, size, power, best):
    """The gain goes with a power of the factor, and what explains most lies near the factor of gain 1, on either side."""
    monkeypatch.setattr(command_factor, "_middle_gain", lambda factor: (factor / size) ** power)
    monkeypatch.setattr(command_factor, "_explained", lambda _, factor: -(np.log(factor / (best * size)) ** 2))
    evidence = SimpleNamespace(numbers=SETTINGS.motion, run=1.0, replayer=SimpleNamespace(free_run=float))
    found = command_factor._search(evidence)
    assert np.log(found / size) == pytest.approx(np.log(best), abs=SETTINGS.motion.command_close)
