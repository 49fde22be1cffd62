"""An arm that leaves its constants no room: effects alone are weighed, and a fit says that nothing is left to do."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.errors import InputError
from flexarm_env.identify.fit import add, fit

COULOMB = 0.05


@pytest.fixture(scope="module")
def known() -> Arm:
    """A rigid arm driven by voltage, all of whose constants are known."""
    arm = Arm.load("cu-rigid")
    paths = ("drive.torque_constant", "hub.inertia", "sensors.arm_angle.gain")
    return replace(arm, sensors={"arm_angle": arm.sensors["arm_angle"]}, fixed=paths, columns=None)


@pytest.fixture(scope="module")
def runs(known: Arm) -> list[Recording]:
    machine = known.with_effect("coulomb", torque=COULOMB)
    return [simulate(machine, "square", duration=3.0, rate=100.0, seed=5)]


def test_an_effect_is_named_where_every_constant_is_fixed(known, runs):
    found = diagnose(known, runs, jobs=1)
    assert found.effects == ["coulomb"]
    assert found.error["final"] < 1.2 < found.error["nominal"]
    assert found.arm.value("effects.coulomb.torque") == pytest.approx(COULOMB, rel=0.05)
    assert [estimate for estimate in found.constants if not estimate.startswith("coulomb")] == []


def test_an_effect_is_added_where_every_constant_is_fixed(known, runs):
    found = add("coulomb", known, runs, jobs=1)
    assert found.arm.value("effects.coulomb.torque") == pytest.approx(COULOMB, rel=0.05)
    assert {e.path for e in found.estimates} == {"effects.coulomb.torque"}


def test_nothing_is_missing_where_every_constant_is_fixed_and_right(known):
    found = diagnose(known, [simulate(known, "square", duration=3.0, rate=100.0, seed=5)], jobs=1)
    assert (found.verdict, found.effects) == ("nothing_missing", [])


def test_a_fit_with_nothing_to_fit_is_refused_in_one_line(known, runs):
    with pytest.raises(InputError, match=r"leaves nothing to fit.*fixed") as caught:
        fit(known, runs)
    assert "\n" not in str(caught.value)
