"""Faults that several recordings show together: a unit of all, a lag beside wrong constants, what is an effect's instead."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.identify.inspect.clock import is_drive_delay
from flexarm_env.identify.inspect.motion import motion_faults
from flexarm_env.identify.settings import SETTINGS
from tests.identify.inspect.faulty import CLOSE, found_in, late, sound, with_signal


def test_each_recording_has_faults_of_its_own():
    faulty = replace(with_signal(sound(), "arm_angle", lambda values: -values), name="other")
    (fault,) = motion_faults(Arm.load("thesis"), [sound(), faulty])
    assert fault.recording == "other"


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


@pytest.mark.parametrize("arm", ["thesis", "thesis-fem"])
@pytest.mark.parametrize("delay", [0.055, 0.06])
def test_half_a_period_late_is_not_turned_round(arm, delay):
    """Square and sweep ring at 8 Hz; the pulses alone tell a lag from a sign."""
    model = Arm.load(arm)
    late_drive = model.with_effect("input_delay", delay=delay)
    runs = [simulate(late_drive, name, duration=6.0, rate=250.0, seed=2, name=name) for name in ("square", "pulse", "sweep")]
    found = motion_faults(model, runs)
    assert [(one.kind, one.signal) for one in found] == [("clock", "")] * 3
    assert all(one.value == pytest.approx(delay, rel=0.05) for one in found)
    assert is_drive_delay(found, len(runs), SETTINGS.motion)
    assert not is_drive_delay(found[:2], len(runs), SETTINGS.motion)


@pytest.mark.parametrize(("delay", "verdict"), [(0.08, "effects"), (0.3, "recordings")])
def test_a_drive_that_acts_late_is_an_effect_and_one_too_late_a_clock(delay, verdict):
    model = Arm.load("cu-rigid")
    late_drive = model.with_effect("input_delay", delay=delay)
    runs = [simulate(late_drive, name, duration=6.0, rate=250.0, seed=2, name=name) for name in ("square", "pulse")]
    found = diagnose(model, runs, jobs=1)
    assert found.verdict == verdict
    if verdict == "recordings":
        assert [one.value for one in found.recordings] == pytest.approx([delay] * 2, rel=CLOSE)
        return
    assert found.effects[0] in ("input_delay", "time_offset")
    (estimate,) = (one for name, one in found.constants.items() if name.startswith(found.effects[0]))
    assert estimate.value == pytest.approx(delay, rel=CLOSE)
    assert any("late against the command" in note for note in found.notes)


#: Motors that drive an axis through soft gears with play: constant, ratio, both inertias, stiffness, friction and gap, in SI.
PLAY = [
    (0.107, 3.0, 0.000427, 0.0111, 40.1, 0.005, 0.096, 0.24),
    (0.678, 3.0, 0.00397, 0.016, 39.5, 0.0155, 0.474, 0.32),
    (0.0614, 1.5, 0.00193, 0.00324, 16.9, 0.00586, 0.0245, 0.14),
    (0.149, 1.0, 0.000463, 0.00102, 5.63, 0.000905, 0.0295, 0.176),
    (0.567, 1.5, 0.0113, 0.00909, 35.9, 0.00617, 0.249, 0.17),
]


@pytest.mark.parametrize("numbers", PLAY)
def test_play_on_soft_gears_is_no_lag_of_the_angle(numbers):
    motor, ratio, motor_inertia, inertia, stiffness, viscous, coulomb, gap = numbers
    drive = {"input": "current", "limit": 1.0, "torque_constant": motor, "gear_ratio": ratio, "motor_inertia": motor_inertia}
    effects = {"viscous": {"coefficient": viscous}, "coulomb": {"torque": coulomb}}
    sensors = {"arm_angle": {"resolution": 8e-4}, "motor_speed": {"noise": 0.05 * ratio}}
    table = {"drive": drive | {"gear_stiffness": stiffness}, "hub": {"inertia": inertia}, "effects": effects, "sensors": sensors}
    arm = Arm.from_table(table, "axis")
    run = simulate(arm.with_effect("backlash", gap=gap), "square", duration=6.0, rate=250.0, seed=3)
    assert motion_faults(arm, [run]) == []
