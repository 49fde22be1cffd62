"""Noise that the arm file leaves to the recordings, and notes where the two disagree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, InputError, Recording, compare, fit, inspect_recordings, simulate
from flexarm_env.controllers.estimator import Estimator
from flexarm_env.env.setup import Setup
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.reading_noise import SensorNoise
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.parameters import reading_noise
from flexarm_env.recordings.noise import Noise
from flexarm_env.tasks.slew import SLEW

AUTO = """
name = "auto"
[drive]
torque_constant = 0.33
gear_ratio = 1.5
motor_inertia = 0.002
limit = 5
[hub]
inertia = 0.05
[sensors.arm_angle]
noise = "auto"
[sensors.motor_speed]
noise = "0.03 rad/s"
"""


def saved(tmp_path, text: str) -> Arm:
    path = tmp_path / "arm.toml"
    path.write_text(text)
    return Arm.load(path)


def unstated(arm: Arm, auto: bool = True) -> Arm:
    """The arm without the noise of its sensors."""
    sensors = {signal: {**table, "noise": 0.0, "resolution": 0.0} for signal, table in arm.sensors.items()}
    return replace(arm, sensors=sensors, auto_noise=tuple(sensors) if auto else ())


def test_auto_is_read_and_saved(tmp_path):
    arm = saved(tmp_path, AUTO)
    assert list(arm.auto_noise) == ["arm_angle"]
    arm.save(tmp_path / "again.toml")
    assert 'noise = "auto"' in (tmp_path / "again.toml").read_text()
    assert Arm.load(tmp_path / "again.toml") == arm


def test_another_word_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"sensors.arm_angle.noise"):
        saved(tmp_path, AUTO.replace('"auto"', '"automatic"'))


@pytest.mark.parametrize("auto", [True, False])
@pytest.mark.parametrize(
    ("name", "rate"), [("thesis", 100.0), ("thesis-fem", 500.0), ("cu-flexible", 250.0), ("cu-rigid", 1000.0)]
)
def test_the_noise_of_the_sensors_is_found(name, rate, auto):
    arm = Arm.load(name)
    runs = [simulate(arm, kind, duration=6.0, rate=rate, seed=4) for kind in ("pulse", "square")]
    reduced, data = prepare(unstated(arm, auto), runs)
    for signal, found in zip(data.signals, data.noise, strict=True):
        assert found == pytest.approx(reading_noise(arm.sensors[signal]), rel=0.15), signal
        assert reading_noise(reduced.sensors[signal]) == found
    assert all("found in the recordings" in note for note in data.notes[: len(data.signals)])


RIGID_BY_VOLTAGE = """
name = "rigid-voltage"
[drive]
input = "voltage"
resistance = 4.2
torque_constant = 0.05
gear_ratio = 20
motor_inertia = 1e-5
limit = 12
[hub]
inertia = 0.02
[sensors.arm_angle]
resolution = "0.0015 rad"
[sensors.motor_speed]
noise = "0.4 rad/s"
"""


def inspected_arm(name: str, tmp_path) -> Arm:
    return saved(tmp_path, RIGID_BY_VOLTAGE) if name == "rigid-voltage" else Arm.load(name)


@pytest.mark.parametrize("auto", [True, False])
@pytest.mark.parametrize("name", ["thesis-fem", "cu-rigid", "cu-flexible", "rigid-voltage"])
def test_an_inspection_shows_the_noise_that_is_used(tmp_path, name, auto):
    """A sweep shakes the beam as fast as noise does; the noise is that of the sensor all the same, in every recording."""
    truth = inspected_arm(name, tmp_path)
    runs = [simulate(truth, kind, duration=6.0, rate=250.0, seed=4) for kind in ("sweep", "pulse")]
    arm = unstated(truth) if auto else truth
    found = {(one.recording, one.signal): one.noise for one in inspect_recordings(arm, runs).signals}
    assert len(found) == 2 * len(truth.sensors)
    for (_, signal), noise in found.items():
        assert noise == pytest.approx(reading_noise(truth.sensors[signal]), rel=0.15), signal
    if auto:
        _, data = prepare(arm, runs)
        assert {signal: found["sweep", signal] for signal in data.signals} == dict(zip(data.signals, data.noise, strict=True))


@pytest.mark.parametrize("name", ["thesis-fem", "cu-rigid", "cu-flexible", "rigid-voltage"])
def test_an_inspection_shows_the_noise_at_rest(tmp_path, name):
    """Where a coarse reading stands on one step, no reading shows the rounding: the noise is not made up."""
    truth = inspected_arm(name, tmp_path)
    time = np.arange(0.0, 6.0, 0.004)
    rest = Recording.from_arrays("rest", time, truth.input, np.zeros_like(time), {"arm_angle": np.zeros_like(time)})
    run = simulate(truth, rest, seed=4)
    found = {one.signal: one.noise for one in inspect_recordings(unstated(truth), [run]).signals}
    shows = [s for s in truth.sensors if truth.sensors[s]["noise"] > 0.5 * truth.sensors[s]["resolution"]]
    for signal in shows:
        assert found[signal] == pytest.approx(reading_noise(truth.sensors[signal]), rel=0.15), signal
    for signal in set(truth.sensors) - set(shows):
        assert not found[signal]


@pytest.mark.parametrize("rows", [2, 3, 10])
@pytest.mark.parametrize(
    ("name", "signal", "rate"),
    [("thesis-fem", "strain_base", 500.0), ("thesis", "motor_speed", 500.0), ("cu-flexible", "tip_deflection", 250.0)],
)
def test_a_slow_sensor_has_the_noise_of_its_readings(name, signal, rate, rows):
    truth = Arm.load(name)
    runs = [simulate(truth, kind, duration=6.0, rate=rate, seed=4) for kind in ("pulse", "square")]
    slow = []
    for run in runs:
        values = run.signals[signal]
        slow.append(replace(run, signals=run.signals | {signal: values[np.arange(len(values)) // rows * rows]}))
    noise = reading_noise(truth.sensors[signal])
    assert not [note for note in prepare(truth, slow)[1].notes if "noise" in note]
    data = prepare(unstated(truth), slow)[1]
    assert data.noise[data.signals.index(signal)] == pytest.approx(noise, rel=0.15)
    shown = [one.noise for one in inspect_recordings(truth, slow).signals if one.signal == signal]
    assert shown == pytest.approx([noise, noise], rel=0.15)


def test_a_stated_step_counts_where_the_recordings_do_not_show_it():
    arm = Arm.load("cu-rigid")
    sensors = {**arm.sensors, "arm_angle": {**arm.sensors["arm_angle"], "noise": 0.0, "resolution": 0.01}}
    _, data = prepare(
        replace(arm, sensors=sensors, auto_noise=("arm_angle",)), [simulate(arm, "pulse", duration=3.0, rate=200.0)]
    )
    assert data.noise[0] == pytest.approx(0.01 / 12**0.5)


@pytest.mark.parametrize(("factor", "share"), [(7.0, "7 times as much"), (1.0 / 7.0, "1/7 of it"), (1.5, ""), (1.0 / 1.5, "")])
def test_a_note_says_that_file_and_recordings_disagree(factor, share):
    arm = Arm.load("thesis")
    run = simulate(arm, "pulse", duration=6.0, rate=500.0)
    table = arm.sensors["motor_speed"]
    off = {**table, "noise": table["noise"] / factor, "resolution": table["resolution"] / factor}
    notes = compare(replace(arm, sensors={**arm.sensors, "motor_speed": off}), [run], rate=0).notes
    told = [note for note in notes if "the arm file says noise" in note]
    assert len(told) == bool(share)
    if share:
        ratio = float(told[0].split("rad/s, ")[-1].removeprefix("1/").split()[0])
        assert ratio == pytest.approx(7.0, rel=0.1)
        assert "motor_speed" in told[0]
        assert 'noise = "auto"' in told[0]


@pytest.mark.parametrize("name", ["thesis", "thesis-fem", "cu-flexible", "cu-rigid", "emps"])
@pytest.mark.parametrize("rate", [100.0, 1000.0])
def test_sound_recordings_raise_no_note(name, rate):
    arm = Arm.load(name)
    if not arm.constants["drive"]["limit"]:
        arm = arm.with_values({"drive.limit": 5.0})
    runs = [simulate(arm, kind, duration=4.0, rate=rate, seed=3) for kind in ("pulse", "square", "sweep")]
    assert not [note for note in prepare(arm, runs)[1].notes if "noise" in note]


def test_the_practice_recordings_show_their_noise(measurements):
    arm = Arm.load("thesis-fem")
    for case in ("p01", "p04"):
        _, data = prepare(unstated(arm), Recording.read_all(measurements / "practice" / case))
        assert data.noise == pytest.approx([reading_noise(table) for table in arm.sensors.values()], rel=0.15)


def test_a_fit_keeps_auto_and_says_the_noise(tmp_path):
    arm = saved(tmp_path, AUTO)
    machine = replace(arm.with_values({"hub.inertia": 0.055, "sensors.arm_angle.noise": 0.002}), auto_noise=())
    found = fit(arm, [simulate(machine, "pulse", duration=3.0, rate=200.0)])
    assert found.error["refitted"] == pytest.approx(1.0, abs=0.1)
    assert any(note.startswith("arm_angle: noise 0.00") and note.endswith("found in the recordings") for note in found.notes)
    assert found.arm.auto_noise == arm.auto_noise
    found.arm.save(tmp_path / "fitted.toml")
    assert Arm.load(tmp_path / "fitted.toml").sensors == found.arm.sensors


def test_a_simulation_says_that_it_has_no_such_noise(tmp_path):
    arm = saved(tmp_path, AUTO)
    run = simulate(arm, "pulse", duration=2.0, rate=100.0)
    assert len(run.notes) == 1
    assert "no noise on arm_angle" in run.notes[0]
    assert simulate(arm, "pulse", duration=2.0, rate=100.0, noise=False).notes == ()


def test_environments_and_controllers_require_a_number(tmp_path):
    arm = saved(tmp_path, AUTO)
    with pytest.raises(InputError, match='noise = "auto" for arm_angle'):
        Setup(SLEW, arm)
    with pytest.raises(InputError, match='noise = "auto" for arm_angle'):
        Estimator(arm, 0.005)


NUMBERS = SETTINGS.preparation


@pytest.mark.parametrize(
    ("stated", "shown", "span", "rounding", "deviation"),
    [
        (0.5, 0.1, 3.0, 2.0, 0.5),  # what the arm file states counts
        (0.0, 0.1, 3.0, 0.0, 0.1),
        (0.0, 0.1, 3.0, 0.2, 0.2),
        (0.0, 1e-300, 3.0, 0.0, 3.0 * NUMBERS.least_noise_share),
        (0.0, None, 3.0, 0.0, 3.0 * NUMBERS.default_noise),
        (0.0, None, 3.0, 1.0, 1.0),
        (0.0, None, 0.0, 0.0, NUMBERS.least_noise),
        (0.0, 1e-300, 0.0, 0.0, NUMBERS.least_noise),
    ],
)
def test_the_noise_of_a_reading_by_its_source(stated, shown, span, rounding, deviation):
    found = None if shown is None else Noise(shown, 0.0, None, None, shown)
    assert SensorNoise("arm_angle", stated, found, span, rounding).deviation(NUMBERS) == pytest.approx(deviation, rel=1e-12)
