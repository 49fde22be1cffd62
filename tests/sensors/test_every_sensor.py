"""What every sensor promises, so that a new one is tested as soon as it is there."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from flexarm_env.arm import Arm
from flexarm_env.arm_sections import SENSOR
from flexarm_env.errors import InputError
from flexarm_env.experiments.simulate import simulate
from flexarm_env.recordings.recording import Recording
from flexarm_env.sensors import Sensor, known_sensors
from flexarm_env.sensors.checks import checked
from flexarm_env.units import check_unit

SENSORS = known_sensors()
NAMES = list(SENSORS)


def defaults(sensor: type[Sensor], **changes: float) -> dict[str, float]:
    return {key: p.typical for key, p in sensor.settings().items()} | changes


def with_sensor(arm: Arm, name: str, **changes: float) -> Arm:
    return replace(arm, sensors={**arm.sensors, name: defaults(SENSORS[name], **changes)})


@pytest.fixture(scope="module")
def thesis() -> Arm:
    return Arm.load("thesis")


def test_the_signals_come_in_their_usual_order():
    shipped = ("arm_angle", "motor_speed", "strain_mid", "strain_base", "tip_deflection")
    assert [name for name in NAMES if name in shipped] == list(shipped)


@pytest.mark.parametrize("name", NAMES)
def test_it_says_what_it_is(name):
    sensor = SENSORS[name]
    assert checked(sensor) is sensor
    assert re.fullmatch(r"[a-z]+(_[a-z]+)*", name)
    assert sensor.__module__ == f"flexarm_env.sensors.{name}"
    assert (sensor.__doc__ or "").strip()
    assert sensor.label.strip()
    check_unit(sensor.unit)


@pytest.mark.parametrize("name", NAMES)
def test_its_settings_are_whole(name):
    settings = SENSORS[name].settings()
    assert set(settings) == set(SENSOR)
    assert settings["noise"].unit == settings["offset"].unit == SENSORS[name].unit
    for key, p in (*settings.items(), ("sensor_offset", SENSORS[name].offset_parameter())):
        assert p.low <= p.typical <= p.high, key
        if p.unit:
            check_unit(p.unit)


@pytest.mark.parametrize("name", NAMES)
def test_it_reads_zero_at_rest_and_moves_with_the_arm(thesis, name):
    arm = with_sensor(thesis, name)
    made = simulate(arm, "pulse", duration=1.5, noise=False).signals[name]
    assert made[:200].any() == 0.0
    assert np.isfinite(made).all()
    assert 0.0 < np.abs(made).max() < SENSORS[name].range_end()


@pytest.mark.parametrize("name", NAMES)
def test_gain_and_offset_do_what_they_say(thesis, name):
    plain, changed = (with_sensor(thesis, name, **c) for c in ({}, {"gain": -2.0, "offset": 0.25}))
    runs = [simulate(arm, "pulse", duration=1.0, noise=False).signals[name] for arm in (plain, changed)]
    assert runs[1] == pytest.approx(-2.0 * runs[0] + 0.25, rel=1e-12, abs=1e-12)


def filtered(samples: np.ndarray, interval: float, lag: float) -> np.ndarray:
    """What a first-order filter makes of samples, straight in between."""
    found = np.zeros(len(samples))
    for k in range(1, len(found)):
        found[k] = found[k - 1] + (0.5 * (samples[k] + samples[k - 1]) - found[k - 1]) * -math.expm1(-interval / lag)
    return found


@pytest.mark.parametrize("name", NAMES)
def test_its_filter_is_of_first_order(thesis, name):
    """Filters change places: the fast one's reading through the slow one is the slow one's reading through the fast one."""
    interval, lags = 1e-4, (0.003, 0.03)
    arms = [with_sensor(thesis, name, filter=lag) for lag in lags]
    runs = [simulate(arm, "pulse", duration=0.9, rate=1 / interval, noise=False).signals[name] for arm in arms]
    both = [filtered(run, interval, lag) for run, lag in zip(runs, reversed(lags), strict=True)]
    assert np.abs(both[0] - both[1]).max() < 2e-3 * np.abs(both[0]).max()


@pytest.mark.parametrize("name", NAMES)
def test_stacked_arms_read_as_each_alone(thesis, name):
    arms = [with_sensor(thesis.with_values({"beam.length": x}), name, position=0.3 * x, filter=0.01 * x) for x in (0.8, 1.0)]
    plant = arms[0].plant(0.005)
    stacked = plant.constants_of([arm.structure() for arm in arms], [arm.laws() for arm in arms])
    for row, arm in zip(stacked, arms, strict=True):
        assert row.tobytes() == arm.plant(0.005).constants.tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_its_column_is_written_and_read_with_its_unit(thesis, tmp_path, name):
    made = simulate(with_sensor(thesis, name), "pulse", duration=0.7)
    made.write(tmp_path / "made.csv")
    assert f"{name} [{SENSORS[name].unit}]" in (tmp_path / "made.csv").read_text().splitlines()[0]
    again = Recording.read(tmp_path / "made.csv")
    assert again.signals[name].tobytes() == made.signals[name].tobytes()


@pytest.mark.parametrize("name", [name for name in NAMES if "beam" in SENSORS[name].needs])
def test_an_arm_without_a_beam_is_refused(tmp_path, name):
    arm = with_sensor(Arm.load("cu-rigid"), name)
    arm.save(tmp_path / "rigid.toml")
    for refused in (lambda: Arm.load(tmp_path / "rigid.toml"), lambda: arm.plant(0.005)):
        with pytest.raises(InputError, match=f"sensors.{name} measures the beam, and the arm has none") as error:
            refused()
        assert "\n" not in str(error.value)
