"""What each effect does, done by hand at a few points: its laws, of which the kernel is compiled, and the quantities it edits."""

from __future__ import annotations

import inspect
import math
from operator import attrgetter
from typing import Any

import pytest

from flexarm_env.arm import Arm
from flexarm_env.effects import catalogue
from flexarm_env.effects.catalogue import LAW_PORTS
from flexarm_env.errors import InputError
from flexarm_env.plant.reading import Channel
from flexarm_env.plant.structure import Structure
from flexarm_env.sensors import known_sensors

HALF = math.log(2.0)  # time constants after which half is left
#: Parameters and what the port gives, with the value that follows.
BY_HAND: dict[tuple[str, str], list[tuple[dict[str, Any], float]]] = {
    ("air_drag", "drag"): [({"coefficient": 0.5, "velocity": v}, f) for v, f in ((2.0, -2.0), (-3.0, 4.5), (0.0, 0.0))],
    ("asymmetric_coulomb", "friction"): [
        ({"torque": 0.2, "direction": side, "at_rest": rest}, f)
        for side, rest, f in ((1.0, False, 0.2), (-1.0, False, -0.2), (1.0, True, 0.0))
    ],
    ("asymmetric_viscous", "friction"): [
        ({"coefficient": 0.1, "direction": side, "speed": 3.0}, f) for side, f in ((1.0, 0.3), (-1.0, -0.3))
    ],
    ("back_driving", "friction"): [
        ({"coefficient": 0.1, "load": load, "direction": side}, f)
        for load, side, f in ((-2.0, 1.0, 0.2), (2.0, -1.0, 0.2), (2.0, 1.0, 0.0), (-2.0, -1.0, 0.0))
    ],
    ("base_tilt", "weight"): [
        ({"torque": 2.0, "angle": angle, "uphill": uphill}, f)
        for angle, uphill, f in ((math.pi / 2, 0.0, 2.0), (1.0, 1.0 + math.pi / 6, -1.0))
    ],
    ("brush_drop", "drive"): [  # 2 A are lost
        ({"drop": 1.0, "resistance": 0.5, "command": command}, through)
        for command, through in ((5.0, 3.0), (-5.0, -3.0), (2.0, 0.0), (1.9, 0.0), (-2.0, 0.0))
    ],
    ("cogging", "torque"): [
        ({"amplitude": 2.0, "cycles": 3.0, "angle": angle, "phase": phase}, f)
        for angle, phase, f in ((math.pi / 6, 0.0, 2.0), (0.0, math.pi / 2, 2.0), (math.pi / 6, -math.pi / 3, 1.0))
    ],
    ("coulomb", "friction"): [({"torque": 0.3}, 0.3)],
    ("dead_zone", "drive"): [
        ({"width": 2.0, "command": command}, through)
        for command, through in ((5.0, 3.0), (-5.0, -3.0), (2.0, 0.0), (1.9, 0.0), (-2.0, 0.0))
    ],
    ("end_stop", "torque"): [
        ({"stiffness": 10.0, "upper": 1.0, "lower": -2.0, "damping_time": 0.1, "angle": angle, "speed": speed}, f)
        for angle, speed, f in (
            (1.5, 0.0, -5.0),
            (1.5, 1.0, -6.0),
            (1.5, -6.0, 0.0),  # a stop does not pull
            (-2.5, 0.0, 5.0),
            (-2.5, -1.0, 6.0),
            (-2.5, 6.0, 0.0),
            (1.0, 9.0, 0.0),
            (-2.0, -9.0, 0.0),
        )
    ],
    ("friction_warmup", "factor"): [
        ({"share": 0.4, "time_constant": 10.0, "time": time}, factor) for time, factor in ((0.0, 1.0), (10.0 * HALF, 0.8))
    ],
    ("kinematic_error", "spring"): [
        ({"stiffness": 100.0, "amplitude": 0.01, "motor_angle": angle, "phase": phase}, f)
        for angle, phase, f in ((math.pi / 4, 0.0, 1.0), (0.0, math.pi / 6, 0.5))
    ],
    ("load_friction", "friction"): [({"coefficient": 0.1, "load": load}, 0.2) for load in (2.0, -2.0)],
    ("position_friction", "friction"): [
        ({"amplitude": 2.0, "cycles": 3.0, "angle": angle, "phase": phase}, f)
        for angle, phase, f in ((math.pi / 6, 0.0, 2.0), (0.0, math.pi / 2, 2.0), (math.pi / 6, -math.pi / 3, 1.0))
    ],
    ("pot_nonlinearity", "sensor"): [
        ({"amplitude": 0.2, "cycles": math.pi, "reading": 1.0, "angle": angle, "phase": phase}, y)
        for angle, phase, y in ((0.5, 0.0, 1.2), (1.0, math.pi / 2, 0.8))
    ],
    ("presliding", "presliding"): [  # half of the way to the level of 2 Nm after 0.2 ln 2 rad
        ({"compliance": 0.1, "before": before, "travel": travel, "level": level}, f)
        for before, travel, level, f in (
            (0.0, 0.2 * HALF, 2.0, 1.0),
            (0.0, -0.2 * HALF, 2.0, -1.0),
            (2.0, -0.2 * HALF, 2.0, 0.0),
            (0.5, 0.0, 2.0, 0.5),
            (0.5, 0.1, 0.0, 0.0),
        )
    ],
    ("rate_limit", "drive"): [
        ({"rate": 10.0, "interval": 0.1, "previous": 1.0, "command": command}, through)
        for command, through in ((5.0, 2.0), (-5.0, 0.0), (1.5, 1.5), (0.5, 0.5))
    ],
    ("rate_limit", "ramp"): [
        ({"rate": rate, "previous": 1.0, "command": command, "start": start, "end": end}, mean)
        for rate, command, start, end, mean in (
            (10.0, 5.0, 0.0, 0.2, 2.0),
            (10.0, 5.0, 0.1, 0.3, 3.0),
            (10.0, -5.0, 0.1, 0.3, -1.0),
            (10.0, 2.0, 0.0, 0.2, 1.75),  # arrives in the middle
            (10.0, 0.0, 0.0, 0.2, 0.25),
            (10.0, 2.0, 0.05, 0.1, 1.75),  # arrives at the end
            (10.0, 2.0, 0.1, 0.3, 2.0),
            (10.0, 1.0, 0.0, 0.1, 1.0),
            (0.0, 5.0, 0.0, 0.1, 1.0),
        )
    ],
    ("saturation", "drive"): [
        ({"limit": 2.0, "command": command}, through) for command, through in ((3.0, 2.0), (-3.0, -2.0), (1.0, 1.0), (-1.0, -1.0))
    ],
    ("shear_thinning", "friction"): [
        ({"coefficient": 0.2, "knee": 0.5, "speed": speed}, f) for speed, f in ((0.0, 0.0), (1.5, 0.15), (4.0, 0.8 / 3.0))
    ],
    ("stiction", "friction"): [({"extra": 0.3, "at_rest": rest}, f) for rest, f in ((True, 0.3), (False, 0.0))],
    ("stiffening", "spring"): [
        ({"knee": 0.1, "stiffness": 100.0, "windup": windup}, f) for windup, f in ((0.1, 10.0), (0.2, 80.0), (-0.2, -80.0))
    ],
    ("strain_drift", "sensor"): [({"rate": 0.01, "reading": 1.0, "time": 10.0}, 1.1)],
    ("stribeck", "friction"): [
        ({"extra": 2.0, "falloff_speed": 0.5, "speed": speed}, f)
        for speed, f in ((0.0, 2.0), (0.5, 2.0 / math.e), (1.0, 2.0 / math.e**4))
    ],
    ("tach_ripple", "sensor"): [
        ({"amplitude": 0.1, "reading": 3.0, "motor_angle": angle, "phase": phase}, y)
        for angle, phase, y in ((math.pi / 6, 0.0, 3.15), (0.0, -math.pi / 2, 2.7))
    ],
}
#: Values, and what becomes of the quantities of an arm of which all are 3.
CHANGES: dict[str, list[tuple[dict[str, float], dict[str, float]]]] = {
    "backlash": [({"gap": 0.5}, {"gear_gap": 3.5})],
    "beam_damping": [({"time": 0.5}, {"beam_damping": 3.5})],
    "cable_stiffness": [({"stiffness": 0.5, "rest_angle": -4.0}, {"hub_stiffness": 3.5, "hub_torque": 1.0})],
    "constant_torque": [({"torque": -0.5}, {"hub_torque": 2.5})],
    "current_lag": [({"time": 0.5}, {"current_lag": 3.5})],
    "fixture_compliance": [
        (
            {"stiffness": 4.0, "inertia": 0.5, "damping_time": 0.1},
            {"fixture_compliance": 0.25, "fixture_inertia": 0.5, "fixture_damping_time": 0.1},
        )
    ],
    "gear_compliance": [
        ({"stiffness": 0.25, "damping_time": 0.1}, {"gear_compliance": 4.0, "gear_damping_time": 0.1}),
        ({"stiffness": 0.5, "damping_time": 0.1}, {}),  # stiffer than the gears are
    ],
    "higher_modes": [({"elements": 4.0}, {"elements": 4}), ({"elements": 2.0}, {})],
    "input_delay": [({"delay": 0.5}, {"input_delay": 3.5})],
    "payload": [({"mass": 0.5}, {"payload": 3.5})],
    "root_compliance": [({"compliance": 0.5}, {"root_compliance": 3.5})],
    "servo_gain": [({"factor": 0.5}, {"position_gain": 1.5, "rate_gain": 1.5})],
    "supply_sag": [({"resistance": 0.5}, {"supply_resistance": 3.5})],
    "time_offset": [({"offset": -0.5}, {"input_delay": 2.5})],
    "tip_inertia": [({"inertia": 0.5}, {"tip_inertia": 3.5})],
    "viscous": [({"coefficient": 0.5}, {"viscous": 3.5})],
    "sensor_offset": [
        (
            {signal: 0.5 * place for place, signal in enumerate(known_sensors())},
            {f"{signal}.offset": 3.0 + 0.5 * place for place, signal in enumerate(known_sensors()) if place},
        )
    ],
    "strain_lag": [({"time": 0.5}, {f"{signal}.filter": 3.5 for signal, sensor in known_sensors().items() if sensor.strain})],
    "tach_filter": [({"time": 0.5}, {"motor_speed.filter": 3.5})],
}
#: Parameters that may be negative: they have a direction, a place or a phase. All others are sizes.
WITH_A_SIDE = {
    "asymmetric_coulomb.torque",
    "asymmetric_viscous.coefficient",
    "back_driving.coefficient",
    "base_tilt.uphill",
    "cable_stiffness.rest_angle",
    "cogging.phase",
    "constant_torque.torque",
    "end_stop.lower",
    "end_stop.upper",
    "friction_warmup.share",
    "kinematic_error.phase",
    "position_friction.phase",
    "pot_nonlinearity.phase",
    "strain_drift.rate",
    "tach_ripple.phase",
    "time_offset.offset",
    *(f"sensor_offset.{signal}" for signal in catalogue()["sensor_offset"].parameters),
}


@pytest.mark.parametrize(
    ("name", "port"), [(name, port) for name in catalogue() for port in LAW_PORTS if catalogue()[name].port(port)]
)
def test_its_law_is_its_equation(name, port):
    law = catalogue()[name].port(port)
    for given, expected in BY_HAND[name, port]:
        assert set(given) == set(inspect.signature(law).parameters)
        assert law(**given) == pytest.approx(expected, rel=1e-12, abs=1e-12), given


EDITING = [name for name in catalogue() if catalogue()[name].port("structure")]


def quantities(structure: Structure) -> dict[str, Any]:
    """All quantities of an arm, with those of its sensors."""
    own = {key: value for key, value in vars(structure).items() if key != "sensors"}
    of_sensors = [(f"{signal}.{key}", value) for signal, one in structure.sensors.items() for key, value in vars(one).items()]
    return own | dict(of_sensors)


def all_of(number: int) -> Structure:
    """An arm of which all quantities are one number."""
    arm = Structure(**{key: number for key in inspect.signature(Structure).parameters if key != "sensors"})
    for signal, sensor in known_sensors().items():
        arm.sensors[signal] = Channel(attrgetter(signal), sensor.strain, number, number, number, number)
    return arm


@pytest.mark.parametrize("name", EDITING)
def test_it_changes_its_quantities_alone(name):
    for values, changes in CHANGES[name]:
        arm = all_of(3)
        before = quantities(arm)
        catalogue()[name].port("structure")(arm, **values)
        assert {key: value for key, value in quantities(arm).items() if value != before[key]} == changes


@pytest.mark.parametrize("number", [0, 3])
@pytest.mark.parametrize("name", sorted({*EDITING} - {"fixture_compliance"}))
def test_at_its_null_it_changes_nothing(name, number):
    arm = all_of(number)
    before = quantities(arm)
    catalogue()[name].port("structure")(arm, **catalogue()[name].null_values())
    assert quantities(arm) == before


def test_at_its_null_a_fixture_is_rigid():
    arm = all_of(3)
    catalogue()["fixture_compliance"].port("structure")(arm, **catalogue()["fixture_compliance"].null_values())
    assert arm.fixture_compliance == 0.0


@pytest.mark.parametrize("name", catalogue())
def test_a_size_is_not_negative(name):
    for key, parameter in catalogue()[name].parameters.items():
        assert (parameter.low < 0.0) == (f"{name}.{key}" in WITH_A_SIDE), key
        if parameter.low < 0.0 and parameter.unit:  # a machine mounted the other way round
            assert parameter.low == -parameter.high, key
        if parameter.unit == "rad" and f"{name}.{key}" in WITH_A_SIDE:
            assert parameter.high >= 2.0 * math.pi, key


def test_a_negative_size_is_refused():
    with pytest.raises(InputError, match=r"input_delay\.delay .*out of bounds"):
        Arm.load("thesis").with_effect("input_delay", delay=-0.01)


@pytest.mark.parametrize(
    ("name", "parameter", "units"),
    [
        ("saturation", "limit", {"cu-rigid": "V", "thesis": "A"}),
        ("dead_zone", "width", {"cu-rigid": "V", "thesis": "A"}),
        ("rate_limit", "rate", {"cu-rigid": "V/s", "thesis": "A/s"}),
    ],
)
def test_what_acts_on_the_command_has_its_unit(name, parameter, units):
    arms = {arm: Arm.load(arm).with_effect(name) for arm in units}
    path = f"effects.{name}.{parameter}"
    assert {key: arm.parameter(path).under(arm.input).unit for key, arm in arms.items()} == units


def test_readings_are_tried_early_and_late():
    offsets = {math.copysign(1.0, start["offset"]) for start in catalogue()["time_offset"].starts()}
    assert offsets == {-1.0, 1.0}
