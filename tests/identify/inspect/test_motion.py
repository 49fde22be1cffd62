"""Faults that the model's motion shows: the injected one is found, with its size; a sound recording has none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.inspect import command_factor
from flexarm_env.identify.inspect.evidence import gather
from flexarm_env.identify.inspect.motion import motion_faults
from flexarm_env.identify.settings import SETTINGS

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


def test_each_recording_has_faults_of_its_own():
    faulty = replace(with_signal(sound(), "arm_angle", lambda values: -values), name="other")
    (fault,) = motion_faults(Arm.load("thesis"), [sound(), faulty])
    assert fault.recording == "other"


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


def three_runs() -> list[Recording]:
    return [replace(sound(experiment=name), name=name) for name in ("square", "pulse", "sweep")]


def test_a_unit_is_that_of_all_recordings():
    """The third run hardly moves, so that it shows no factor by itself."""
    square, pulse, _ = three_runs()
    draws = np.random.default_rng(0)
    noise = {name: draws.normal(0.0, 0.01, len(square)) for name in square.signals}
    still = Recording.from_arrays("still", square.time, "current", 0.0 * square.command, noise)
    assert motion_faults(Arm.load("thesis"), [still]) == []
    slow = [with_signal(one, "motor_speed", lambda speed: speed / math.tau) for one in (square, pulse, still)]
    found = motion_faults(Arm.load("thesis"), slow)
    assert [one.recording for one in found] == ["square", "pulse", "still"]
    assert {(one.kind, one.signal) for one in found} == {("factor", "motor_speed")}
    assert all(one.value == pytest.approx(1.0 / math.tau, rel=CLOSE) for one in found)


def test_a_small_factor_in_one_of_three_recordings_is_that_of_an_effect():
    """A ripple of the tachometer once per turn looks like a gain where the motor turns little."""
    square, pulse, sweep = three_runs()

    def ripple(speed):
        return speed * (1.0 - 0.3 * np.cos(1.5 * sweep.signals["arm_angle"]))

    rippled = with_signal(sweep, "motor_speed", ripple)
    assert [one.kind for one in motion_faults(Arm.load("thesis"), [rippled])] == ["factor"]
    assert motion_faults(Arm.load("thesis"), [square, pulse, rippled]) == []


def test_a_spring_that_the_model_lacks_is_no_clock():
    """A cable turns the phase of the motion, early against the model, and most where the commands are slow."""
    arm = Arm.load("thesis").with_effect("viscous", coefficient=0.1).without_effect("coulomb").without_effect("stiction")
    for stiffness in (0.1, 0.3, 1.0):
        sprung = arm.with_effect("cable_stiffness", stiffness=stiffness, rest_angle=0.2)
        runs = [simulate(sprung, name, duration=6.0, seed=3, name=name) for name in ("square", "pulse", "sweep")]
        angle = [replace(run, signals={"arm_angle": run.signals["arm_angle"]}) for run in runs]
        for one in (*runs, *angle):
            assert motion_faults(arm, [one]) == []


def test_the_noise_of_all_signals_counts_from_whichever_the_start_is_read():
    part = with_signal(sound().part(0.3), "motor_speed", lambda speed: speed / 5.0)
    run = gather(Arm.load("thesis"), part, SETTINGS).run
    assert np.isfinite(run.noise).all()


def machine_of(arm: str, **factors: float) -> list[Recording]:
    """Three recordings of a machine whose constants are multiples of those of an arm."""
    model = Arm.load(arm)
    changed = model.with_values({path: factor * model.value(path) for path, factor in factors.items()})
    return [simulate(changed, name, duration=6.0, rate=250.0, seed=2, name=name) for name in ("square", "pulse", "sweep")]


#: Constants of a machine a few percent off those of its arm file.
OFF = {"drive.torque_constant": 1.06, "hub.inertia": 0.95}
BEAM_OFF = {"beam.mass_per_length": 1.05, "beam.bending_stiffness": 0.94}


@pytest.mark.parametrize(("arm", "lag"), [("thesis-fem", 0.4), ("cu-rigid", 0.068), ("cu-flexible", 0.12)])
def test_a_lag_of_all_signals_is_exact_though_the_constants_are_not(arm, lag):
    runs = machine_of(arm, **OFF)
    assert motion_faults(Arm.load(arm), runs) == []
    found = motion_faults(Arm.load(arm), [late(run, lag, tuple(run.signals)) for run in runs])
    assert [(one.kind, one.signal) for one in found] == [("clock", "")] * 3
    assert all(one.value == pytest.approx(lag, rel=CLOSE) for one in found)


@pytest.mark.parametrize(
    ("arm", "signal", "factor"),
    [("cu-flexible", "tip_deflection", 1.9), ("thesis", "strain_mid", 0.55), ("thesis", "strain_mid", 6.3)],
)
def test_a_factor_of_a_beam_s_signal_is_exact_though_the_constants_are_not(arm, signal, factor):
    runs = machine_of(arm, **OFF, **BEAM_OFF)
    assert motion_faults(Arm.load(arm), runs) == []
    found = motion_faults(Arm.load(arm), [with_signal(run, signal, lambda values: factor * values) for run in runs])
    assert [(one.kind, one.signal) for one in found] == [("factor", signal)] * 3
    assert all(one.value == pytest.approx(factor, rel=CLOSE) for one in found)


def test_a_gage_exchanged_with_the_tachometer_is_found_beside_wrong_constants():
    (run, *_) = machine_of("thesis", **OFF)
    exchanged = run.signals | {"motor_speed": run.signals["strain_base"], "strain_base": run.signals["motor_speed"]}
    fault = found_in("thesis", replace(run, signals=exchanged))
    assert (fault.kind, {fault.signal, fault.other}) == ("swapped", {"motor_speed", "strain_base"})


@pytest.mark.parametrize("arm", ["thesis", "cu-rigid", "cu-flexible"])
@pytest.mark.parametrize("lag", [0.012, 0.048])
def test_an_angle_late_by_milliseconds_is_found_against_the_speed(arm, lag):
    """The model has other constants, which change nothing: angle and speed are readings of one motion."""
    runs = [simulate(Arm.load(arm), name, duration=6.0, rate=250.0, seed=2, name=name) for name in ("square", "pulse", "sweep")]
    changed = Arm.load(arm).with_values({"hub.inertia": 1.2 * Arm.load(arm).value("hub.inertia")})
    found = motion_faults(changed, [late(run, lag, ("arm_angle",)) for run in runs])
    assert [(one.kind, one.signal, one.other) for one in found] == 3 * [("clock", "arm_angle", "motor_speed")]
    assert all(one.value == pytest.approx(lag, rel=CLOSE) for one in found)
    assert "late against motor_speed" in found[0].message


@pytest.mark.parametrize("times", [1.0, 4.0])
@pytest.mark.parametrize("effect", ["backlash", "gear_compliance", "tach_filter", "pot_nonlinearity", "tach_ripple"])
def test_effects_between_motor_and_angle_are_no_lag(effect, times):
    arm = Arm.load("thesis")
    sizes = {name: one for name, one in arm.known[effect].parameters.items() if one.null is not None}
    size = {name: one.typical * (times if math.isfinite(one.null) else 1.0 / times) for name, one in sizes.items()}
    machine = arm.with_effect(effect, **size)
    runs = [simulate(machine, name, duration=6.0, seed=2, name=name) for name in ("square", "pulse", "sweep")]
    assert not [one for run in runs for one in motion_faults(arm, [run]) if one.kind == "clock"]


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
