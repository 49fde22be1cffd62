"""Arms that are built together are the arms that are built one by one."""

from __future__ import annotations

import numpy as np
import pytest
from one_joint import elastic_joint, pendulum, servo
from plant_arms import noise, relative

from flexarm_env import Arm
from flexarm_env.plant.plant import Plant

#: What differs between the arms, from which value to which, by what they have in common.
KINDS = {
    "payload": ("thesis", {}, {"effects.payload.mass": (0.0, 0.3)}),
    "length": ("thesis", {}, {"beam.length": (0.8, 1.2), "sensors.strain_mid.position": (0.3, 0.7)}),
    "damping": ("thesis", {}, {"effects.beam_damping.time": (1e-5, 1e-2)}),  # from vibrating to creeping
    "lag": ("thesis", {"current_lag": {}, "tach_filter": {}}, {"effects.current_lag.time": (1e-3, 5e-3)}),
    "cable": ("thesis", {"root_compliance": {}}, {"effects.cable_stiffness.stiffness": (0.1, 1.0)}),
    "laws": ("thesis", {"stribeck": {}, "air_drag": {}}, {"effects.stribeck.extra": (0.01, 0.1)}),
    "two bodies": ("thesis-fem", {}, {"drive.gear_stiffness": (1e3, 1e4), "hub.inertia": (1e-3, 2e-3)}),
    "backlash": ("thesis", {}, {"effects.backlash.gap": (0.01, 0.05), "effects.viscous.coefficient": (0.05, 0.15)}),
    "rigid": ("emps", {}, {"hub.inertia": (50.0, 100.0)}),
    "pendulum": (
        "pendulum",
        {"payload": {}},
        {"link.mass": (0.3, 0.6), "link.tilt": (0.5, 1.5), "effects.payload.mass": (0.1, 0.2)},
    ),
    "joint": ("elastic joint", {"stiffening": {}}, {"joint.stiffness": (1.0, 2.0), "hub.inertia": (1e-4, 2e-4)}),
    "servo": ("servo", {"coulomb": {}}, {"drive.error_gain": (0.002, 0.004), "drive.supply_voltage": (6.0, 8.0)}),
    "fixture": ("pendulum", {"fixture_compliance": {}}, {"effects.fixture_compliance.stiffness": (100.0, 200.0)}),
}
MACHINES = {arm.name: arm for arm in (pendulum(), elastic_joint(), servo())}


def drawn(kind, count=9):
    name, effects, ranges = KINDS[kind]
    arm = MACHINES.get(name) or Arm.load(name)
    for effect, values in effects.items():
        arm = arm.with_effect(effect, **values)
    for path in ranges:
        section, effect, *_ = path.split(".")
        if section == "effects" and effect not in arm.effects:
            arm = arm.with_effect(effect)
    shares = np.linspace(0.05, 1.0, count)
    return [arm.with_values({path: low + share * (high - low) for path, (low, high) in ranges.items()}) for share in shares]


def constants(arms):
    return arms[0].plant(0.005).constants_of([arm.structure() for arm in arms], [arm.laws() for arm in arms])


@pytest.mark.parametrize("kind", KINDS)
def test_company_changes_no_bit(kind):
    arms = drawn(kind)
    together = constants(arms)
    assert np.array_equal(together, np.vstack([constants([arm]) for arm in arms]))
    assert np.array_equal(together[3:5], constants(arms[3:5]))
    assert (together[0] != together[1]).any()


@pytest.mark.parametrize("kind", KINDS)
def test_each_moves_as_its_own_plant_does(kind):
    arms = drawn(kind, 3)
    current = noise(6, 60)
    for arm, row in zip(arms, constants(arms), strict=True):
        own, borrowed = arm.plant(0.005), arms[0].plant(0.005)
        borrowed.constants[:] = row
        for plant in (own, borrowed):
            plant.place()
        assert relative(borrowed.replay(current), own.replay(current)) < 1e-9


def test_arms_of_another_kind_are_refused():
    plant, other = Arm.load("thesis").plant(0.005), Arm.load("thesis-fem")
    with pytest.raises(ValueError, match="another kind"):
        plant.constants_of([other.structure()], [other.laws()])


@pytest.mark.parametrize("kind", KINDS)
def test_plants_of_one_kind_move_as_each_alone(kind):
    arms, current = drawn(kind, 3), noise(6, 60)
    for arm, plant in zip(arms, of_one_kind(arms), strict=True):
        own = arm.plant(0.005)
        assert np.array_equal(plant.layout, own.layout)
        for name, quantity in vars(own.model).items():
            ours = getattr(plant.model, name)
            assert ours == quantity if isinstance(quantity, list) else np.allclose(ours, quantity, rtol=1e-12), name
        for one in (plant, own):
            one.place()
        assert relative(plant.replay(current), own.replay(current)) < 1e-9


def of_one_kind(arms, interval=0.005):
    structures, laws = [arm.structure() for arm in arms], [arm.laws() for arm in arms]
    return Plant.of_one_kind(structures, laws, arms[0].known.laws, interval)


@pytest.mark.parametrize(
    ("effects", "interval"),
    [
        ([{"input_delay": {"delay": 0.004}}, {"input_delay": {"delay": 0.006}}], 0.005),  # a sample more
        ([{"input_delay": {"delay": 0.002}}, {"input_delay": {"delay": 0.018}}], 0.02),  # other substeps
        ([{}, {"gear_compliance": {}}], 0.005),
        ([{"air_drag": {}}, {"cogging": {}}], 0.005),
    ],
)
def test_plants_of_two_kinds_are_refused(effects, interval):
    arms = []
    for own in effects:
        arm = Arm.load("thesis").with_effect("stribeck")
        for name, values in own.items():
            arm = arm.with_effect(name, **values)
        arms.append(arm)
    with pytest.raises(ValueError, match=r"kind|stacked"):
        of_one_kind(arms, interval)
