"""What recordings can show of an arm before any fit: against fits and diagnoses of the same recordings, and at rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, diagnose, fit, simulate
from flexarm_env.identify.inspect.estimate_excitation import estimate_excitation
from flexarm_env.identify.inspect.excitation import (
    DETECTABLE,
    NOT_EXCITED,
    NOT_SHOWN,
    SHOWN,
    TOO_SMALL,
    EffectExcitation,
    Excitation,
)


def recorded(arm: Arm, duration: float = 4.0) -> list[Recording]:
    return [simulate(arm, kind, duration=duration, rate=200.0, seed=seed) for seed, kind in enumerate(("square", "pulse"))]


@pytest.fixture(scope="module")
def rigid() -> Arm:
    return Arm.load("cu-rigid")


@pytest.fixture(scope="module")
def shown(rigid) -> Excitation:
    return estimate_excitation(rigid, recorded(rigid))


def effect(found: Excitation, name: str) -> EffectExcitation:
    return next(one for one in found.effects if one.effect == name)


def test_intervals_are_those_of_a_fit():
    arm = Arm.load("thesis")
    before = {one.path: one for one in estimate_excitation(arm, recorded(arm, 5.0)).constants}
    after = {one.path: one for one in fit(arm, recorded(arm, 5.0)).estimates}
    for path in ("drive.motor_inertia", "hub.inertia", "sensors.motor_speed.gain"):
        assert before[path].half_width == pytest.approx(0.5 * (after[path].high - after[path].low), rel=0.4)
        assert before[path].half_width < before[path].prior


def test_without_a_known_payload_no_motion_shows_the_scale_of_forces():
    arm = Arm.load("thesis")
    light, heavy = recorded(arm)[0], recorded(arm.with_values({"beam.tip_mass": 0.3}))[1]
    known = replace(heavy, conditions={"payload": 0.3})
    assert estimate_excitation(arm, [light]).common_scale == NOT_SHOWN
    assert estimate_excitation(arm, [light, known]).common_scale == SHOWN


@pytest.mark.parametrize("name", ["coulomb", "constant_torque", "saturation"])
def test_thrice_a_limit_is_named_and_a_third_is_not(rigid, shown, name):
    found = effect(shown, name)
    for factor, named in ((1.0 / 3.0, False), (3.0, True)):
        size = found.limit / factor if found.falls else found.limit * factor
        machine = rigid.with_effect(name, **{found.parameter: size})
        assert (name in diagnose(rigid, recorded(machine), jobs=1).effects) == named


def test_a_limit_beyond_the_largest_command_does_not_show(rigid, shown):
    found = effect(shown, "saturation")
    assert found.falls
    assert found.unit == "V"
    assert found.limit < max(np.abs(one.command).max() for one in recorded(rigid))


def test_an_arm_at_rest_shows_nothing(rigid):
    time = np.arange(0.0, 3.0, 0.005)
    still = Recording.from_arrays("still", time, "voltage", np.zeros(len(time)), {s: np.zeros(len(time)) for s in rigid.signals})
    found = estimate_excitation(rigid, [still])
    assert {one.state for one in found.constants} == {NOT_SHOWN}
    assert effect(found, "viscous").state == effect(found, "saturation").state == NOT_EXCITED
    assert effect(found, "saturation").limit is None


def test_a_noisy_sensor_hides_what_a_fine_one_shows(rigid):
    coarse = rigid.with_values({f"sensors.{signal}.noise": 3.0 for signal in rigid.signals})
    states = [effect(estimate_excitation(arm, recorded(arm)), "dead_zone") for arm in (rigid, coarse)]
    assert states[0].state == DETECTABLE
    assert states[1].state in (TOO_SMALL, NOT_EXCITED)
    assert states[0].sizes < states[1].sizes


def test_progress_rises_to_the_end(rigid):
    seen = []
    estimate_excitation(rigid, recorded(rigid), lambda done, text: seen.append(done))
    assert seen == sorted(seen)
    assert len(seen) > 10
    assert seen[-1] < 1.0
