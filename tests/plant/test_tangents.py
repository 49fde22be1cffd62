"""Derivatives of readings against differences of the exact plant, in every mode and through each kind of event."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from plant_arms import COULOMB, SIGNALS, STATIC, noise

from flexarm_env.effects import catalogue
from flexarm_env.plant import layout as at
from flexarm_env.plant.active_laws import ActiveLaw
from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.blocks import blocks_of
from flexarm_env.plant.flat_arrays import pack
from flexarm_env.plant.plant import Plant
from flexarm_env.plant.structure import Structure
from flexarm_env.plant.tangents.constants import PLACES, Neighbours, constant_tangents
from flexarm_env.plant.tangents.tangents import Tangents
from flexarm_env.sensors.arm_angle import ArmAngle
from flexarm_env.sensors.motor_speed import MotorSpeed

#: The shipped effects, for which other tests need the derivatives, too: their kernel takes long to compile.
EFFECTS = catalogue()
BASE = ("hub_inertia", "motor_inertia", "torque_constant", "gear_ratio", "viscous", "law.0.0", "law.1.0")
BEAM = ("length", "mass_per_length", "bending_stiffness")
INTERVAL = 0.005
#: Relative change of a reading by a relative change of a constant below which differences of replays show rounding alone.
NEGLIGIBLE = 1e-9
SWING = 4.0 * np.sin(2 * np.pi * 0.7 * INTERVAL * np.arange(200))
#: Many events, of which none is so near to another that differences of replays disagree.
STRONG, WEAK = noise(0, 60, 4.0), noise(2, 200, 1.0)
UNEVEN = INTERVAL * (1.0 + 0.3 * np.sin(np.arange(200.0)))

#: By name: what differs from one element with base friction, and the constants of that.
ARMS = {
    "rigid": ({"elements": 0}, ()),
    "one element": ({}, BEAM),
    "four elements": ({"elements": 4}, BEAM),
    "cable, lag, damping": (
        {"hub_stiffness": 0.5, "current_lag": 0.004, "beam_damping": 1e-3},
        ("hub_stiffness", "current_lag", "beam_damping"),
    ),
    "root": ({"elements": 2, "root_compliance": 0.01}, ("root_compliance",)),
    "voltage": ({"resistance": 1.2}, ("resistance",)),
    "delay": ({"input_delay": 0.0075}, ("input_delay",)),
    "gears": ({"gear_compliance": 1 / 300}, ("gear_compliance",)),
    "both sides": ({"gear_compliance": 1 / 4000, "share": 0.4}, ("gear_compliance",)),
    "backlash": ({"gear_gap": 0.01}, ("gear_gap",)),
}


class Machine:
    """An arm with its laws, of which any constant can be changed."""

    def __init__(self, structure, laws):
        self.structure, self.laws = structure, tuple(laws)

    def value(self, path):
        if path.startswith("law."):
            _, which, place = path.split(".")
            return self.laws[int(which)].parameters[int(place)]
        return getattr(self.structure, path)

    def moved(self, path, step):
        if not path.startswith("law."):
            return Machine(replace(self.structure, **{path: self.value(path) + step}), self.laws)
        _, which, place = path.split(".")
        laws = list(self.laws)
        parameters = list(laws[int(which)].parameters)
        parameters[int(place)] += step
        laws[int(which)] = replace(laws[int(which)], parameters=tuple(parameters))
        return Machine(self.structure, laws)

    def plant(self):
        plant = Plant(self.structure, self.laws, EFFECTS.laws, INTERVAL)
        plant.place()
        return plant

    def tangents(self, paths, step=1e-3):
        scales = np.array([abs(self.value(path)) for path in paths])
        beside = [self.moved(path, step * scale * k) for path, scale in zip(paths, scales, strict=True) for k in PLACES]
        neighbours = Neighbours([m.structure for m in beside], [m.laws for m in beside], step * scales)
        plant = self.plant()
        return plant, Tangents(plant, constant_tangents(self.structure, self.laws, INTERVAL, neighbours), scales)


def friction(name, level, share):
    return ActiveLaw(EFFECTS.kinds[name, "friction"], "friction", (level,), False, share)


def machine(elements=1, share=0.0, **changes):
    constants = {"viscous": 0.1018, "motor_viscous_share": 0.0177}
    constants["sensors"] = SIGNALS if elements else {"arm_angle": ArmAngle.channel(), "motor_speed": MotorSpeed.channel(1.1)}
    if elements:
        constants |= {"length": 1.0, "mass_per_length": 0.42381, "bending_stiffness": 7.911324}
    return Machine(
        Structure(1.5, 0.33, 0.00193, 0.00129, elements=elements, **(constants | changes)),
        (friction("coulomb", COULOMB, share), friction("stiction", STATIC - COULOMB, share)),
    )


def differences(own, path, readings):
    """Extrapolated central differences (samples, signals), and how well two orders of them agree (signals,).

    Each signal takes the step at which they agree best. Rounding moves readings of some 10 by 1e-14: narrow steps may agree
    on too little.
    """
    best, width = 0.0, np.inf
    for step in 10.0 ** np.arange(-6.0, -1.4, 0.5) * abs(own.value(path)):
        one, two, three = (
            (readings(own.moved(path, h)) - readings(own.moved(path, -h))) / (2 * h) for h in (step, step / 2, step / 4)
        )
        once = (4 * two - one) / 3, (4 * three - two) / 3
        apart = np.max(np.abs(once[1] - once[0]), axis=0) + 1e-14 / step
        best = np.where(apart < width, (16 * once[1] - once[0]) / 15, best)
        width = np.minimum(apart, width)
    return best, width


def compare(own, path, found, readings, tolerance):
    """Compare derivatives (samples, signals) with differences, relative to each signal's largest."""
    wanted, width = differences(own, path, readings)
    size, apart = np.max(np.abs(wanted), axis=0), np.max(np.abs(found - wanted), axis=0)
    least = NEGLIGIBLE * np.max(np.abs(readings(own)), axis=0) / abs(own.value(path))
    assert np.all(apart <= tolerance * size + 3 * width + least), (path, apart, width, size, least)
    assert np.all(width <= 1e-5 * size + least), (path, width, size)


def check(own, paths, command, *options, tolerance=1e-7):
    """Compare the derivatives by constants with differences."""
    _, tangents = own.tangents(paths)
    readings, found = tangents.replay(command, *options)
    assert np.array_equal(readings, own.plant().replay(command, *options))
    for number, path in enumerate(paths):
        compare(own, path, found[..., number], lambda other: other.plant().replay(command, *options), tolerance)


@pytest.mark.slow(minutes=1)
@pytest.mark.parametrize("name", ARMS)
def test_constants_of_arms_with_base_friction(name):
    changes, own = ARMS[name]
    check(machine(**changes), (*BASE, *own), SWING)


def test_a_given_decomposition_is_used_although_the_ordinary_one_is_kept():
    own, asked = machine(), []

    def decompose(dynamics):
        asked.append(dynamics)
        return blocks_of(dynamics)

    ordinary = pack(own.structure, assemble(own.structure), [own.laws], INTERVAL)
    given = pack(own.structure, assemble(own.structure), [own.laws], INTERVAL, decompose)
    assert len(asked) == 2  # the hub free and held
    assert all(np.array_equal(one, other) for one, other in zip(ordinary, given, strict=True))


def modes(own, command):
    """Modes at the samples of a replay."""
    plant = own.plant()
    found = set()
    for two in np.column_stack([command[:-1], command[1:]]):
        plant.replay(two)
        found.add(int(plant.state[at.MODE]))
    return found


@pytest.mark.parametrize(
    ("name", "command", "wanted"),
    [("one element", SWING, {0, 1}), ("both sides", WEAK, {0, 1, 2, 3}), ("backlash", SWING, {0, 1, 4, 5})],
    ids=["one body", "two bodies", "backlash"],
)
def test_runs_of_these_tests_pass_through_the_modes(name, command, wanted):
    assert wanted <= modes(machine(**ARMS[name][0]), command)


@pytest.mark.slow(minutes=1)
@pytest.mark.parametrize(("name", "command"), [("one element", STRONG), ("gears", STRONG), ("both sides", WEAK)])
def test_crowded_events(name, command):
    changes, own = ARMS[name]
    check(machine(**changes), (*BASE, *own), command)


@pytest.mark.slow(minutes=1)
@pytest.mark.parametrize("name", ["rigid", "one element", "delay", "backlash"])
def test_uneven_sampling(name):
    changes, own = ARMS[name]
    check(machine(**changes), (*BASE, *own), SWING, UNEVEN)


def corrected(own, physical, measured, command):
    """Replay with physical gains (modes, states, signals), which do not depend on the constants."""
    plant = own.plant()
    return plant.replay(command, gains=block_gains(plant, physical), measured=measured)


def block_gains(plant, physical):
    gains = np.zeros((plant.modes, 2 * plant.blocks + plant.bodies, physical.shape[2]))
    for mode in range(plant.modes):
        gains[mode, : 2 * plant.blocks] = plant.to_modal(mode) @ physical[mode]
        for body in range(plant.bodies):
            gains[mode, 2 * plant.blocks + body] = physical[mode, body] * (mode >> body & 1)
    return gains


@pytest.mark.slow(minutes=1)
@pytest.mark.parametrize("changes", [{}, {"elements": 2, "hub_stiffness": 0.5}, {"gear_compliance": 1 / 300}])
def test_corrected_replays(changes):
    own, command = machine(**changes), SWING[:120]
    plant, tangents = own.tangents(("hub_inertia", "viscous", "law.0.0", "bending_stiffness"))
    measured = own.moved("hub_inertia", 7e-4).plant().replay(command)
    measured += 0.01 * np.random.default_rng(0).standard_normal(measured.shape)
    measured[7::11, 1] = np.nan
    physical = np.zeros((plant.modes, plant.states, len(plant.signals)))
    physical[:, 0, 0], physical[:, len(plant.model.names), 1], physical[:, 2, 0] = 0.05, 0.1, 0.01
    readings, found = tangents.replay(command, gains=block_gains(plant, physical), measured=measured)
    assert np.array_equal(readings, corrected(own, physical, measured, command))
    for number, path in enumerate(("hub_inertia", "viscous", "law.0.0", "bending_stiffness")):
        compare(own, path, found[..., number], lambda other: corrected(other, physical, measured, command), 1e-7)
