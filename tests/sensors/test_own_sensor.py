"""A new signal is one file: the program of own_sensor_program.py meets two that are dropped into the folder of sensors."""

from __future__ import annotations

import doctest
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from documents import PROJECT, blocks_of

from flexarm_env.errors import InputError
from flexarm_env.sensors import Reading, Sensor, base
from flexarm_env.sensors.checks import checked

SHAFT_ACCELERATION = '''
"""An accelerometer on the hub."""

from typing import ClassVar

from flexarm_env.sensors import Reading, Sensor


class ShaftAcceleration(Sensor):
    """Angular acceleration of the hub."""

    name = "shaft_acceleration"
    unit = "rad/s**2"
    label = "shaft acceleration"
    typical = 20.0
    largest = 500.0
    defaults: ClassVar = {"noise": 0.5, "filter": 0.002}

    @staticmethod
    def reading(coordinates):
        """Angular acceleration of the hub [rad/s²]."""
        return Reading(acceleration=coordinates.hub)
'''
TIP_SPEED = '''
"""The speed of the beam's tip."""

from typing import ClassVar

from flexarm_env.sensors import Reading, Sensor


class TipSpeed(Sensor):
    """Speed of the tip across the beam, from the fixed frame."""

    name = "tip_speed"
    unit = "m/s"
    label = "tip speed"
    needs = ("beam",)
    defaults: ClassVar = {"noise": 0.01}

    @staticmethod
    def reading(coordinates):
        """Speed of the tip [m/s]."""
        return Reading(speed=coordinates.displacement(coordinates.length))
'''
PROGRAM = Path(__file__).with_name("own_sensor_program.py")


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> dict:
    folder = tmp_path_factory.mktemp("own")
    (folder / "sensors").mkdir()
    (folder / "sensors" / "shaft_acceleration.py").write_text(SHAFT_ACCELERATION, encoding="utf-8")
    (folder / "sensors" / "tip_speed.py").write_text(TIP_SPEED, encoding="utf-8")
    one = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    paths = os.pathsep.join([str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
    run = subprocess.run(
        [sys.executable, str(PROGRAM), str(folder)],
        capture_output=True, text=True, check=False, env={**os.environ, **one, "PYTHONPATH": paths},
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    return json.loads((folder / "found.json").read_text())


def test_it_is_simulated_and_written_with_its_unit(found):
    assert "shaft_acceleration [rad/s**2]" in found["header"]
    assert "tip_speed [m/s]" in found["header"]
    assert found["same again"]


def test_an_acceleration_is_force_over_mass(found):
    """A rigid arm without viscous friction: (torque of the drive - Coulomb friction) / inertia while it slides, 0 stuck."""
    sliding, stuck, expected = found["sliding"], found["stuck"], found["expected acceleration"]
    assert sliding == pytest.approx(expected, rel=1e-9)
    assert stuck == pytest.approx(0.0, abs=1e-6)


def test_an_acceleration_does_not_depend_on_the_sampling(found):
    assert found["coarse"] == pytest.approx(found["fine"], abs=1e-5 * np.abs(found["fine"]).max())


def test_the_tip_moves_with_the_hub_and_the_beam(found):
    assert found["tip speed"] == pytest.approx(found["tip speed from angle and deflection"], abs=0.01)


def test_it_is_compared_and_shown_under_its_label(found):
    assert found["compare"] == pytest.approx(1.0, abs=0.05)
    assert {"shaft_acceleration", "tip_speed"} <= set(found["compared"])
    assert "shaft acceleration" in found["table"]
    assert "tip speed" in found["table"]
    assert "rad/s²" in found["table"]


def test_a_moving_start_gives_no_spike(found):
    assert found["compare from motion"] < 1.2


def test_its_gain_and_offset_are_fitted(found):
    gain, offset = found["gain"], found["offset"]
    assert gain["value"] == pytest.approx(1.1, rel=0.02)
    assert gain["unit"] == ""
    assert offset["value"] == pytest.approx(0.3, abs=0.02)
    assert offset["unit"] == "m/s"


def test_it_is_observed(found):
    assert found["observation"] == [8]
    assert found["bounds"] == pytest.approx([500.0, 10.0])
    assert 1.0 < found["observed acceleration"] < 500.0


def test_an_arm_that_cannot_have_it_is_refused(found):
    assert found["refused"].endswith("sensors.tip_speed measures the beam, and the arm has none: add [beam] or leave it out")
    assert "\n" not in found["refused"]


def test_a_recording_without_its_unit_is_refused(found):
    assert "write 'tip_speed [m/s]'" in found["no unit"]


def test_the_recipe_of_the_documents_is_a_sensor():
    (block,) = [b for b in blocks_of(PROJECT / "docs" / "your-sensor.md") if b.file]
    scope: dict = {}
    exec(block.text, scope)
    assert checked(scope["TipAcceleration"])
    assert doctest.testmod(base).failed == 0


def own(**changes: object) -> type[Sensor]:
    whole = {
        "name": "own", "unit": "m", "label": "own",
        "reading": staticmethod(lambda coordinates: Reading(position=coordinates.hub)),
    }  # fmt: skip
    kept = {key: value for key, value in (whole | changes).items() if value is not None}
    return type("Own", (Sensor,), kept)


def test_a_whole_sensor_is_taken():
    assert checked(own())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"unit": None}, "lacks 'unit'"),
        ({"name": "time"}, "name is 'time'"),
        ({"name": "über"}, "name is 'über'"),
        ({"reading": None}, "lacks 'reading'"),
        ({"reading": lambda coordinates, gain: None}, "takes one argument"),
        ({"typical": 0.0}, "typical = 0.0"),
        ({"needs": "beam"}, "needs is a text"),
        ({"needs": ("baem",)}, "did you mean 'beam'"),
        ({"defaults": {"filtr": 0.1}}, "did you mean 'filter'"),
    ],
)
def test_a_sensor_that_is_not_whole_is_refused_in_one_line(changes, message):
    with pytest.raises(InputError, match=message) as error:
        checked(own(**changes))
    assert "\n" not in str(error.value)
