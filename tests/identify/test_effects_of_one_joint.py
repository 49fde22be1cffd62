"""The effects of machines of one joint are recovered from recordings that hold them, beside wrong base constants."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from one_joint import elastic_joint, pendulum, servo

from flexarm_env import Arm, add, simulate


def lubricated() -> Arm:
    return pendulum(vertical=False).with_effect("viscous", coefficient=0.02)


def geared() -> Arm:
    arm = pendulum(vertical=False).with_effect("coulomb", torque=0.02).with_effect("load_friction", coefficient=0.2)
    return replace(arm, fixed=["link.inertia"])  # what is lost on the way there and back is that of any inertia


def damped_pendulum() -> Arm:
    return pendulum().with_effect("viscous", coefficient=0.05)


#: Effect, machine, true values, and the accuracy to which each is recovered.
CASES: list[tuple[str, Callable[[], Arm], dict[str, float], float]] = [
    ("shear_thinning", lubricated, {"coefficient": 0.15, "knee": 0.4}, 0.1),
    ("back_driving", geared, {"coefficient": 0.25}, 0.1),
    ("end_stop", damped_pendulum, {"stiffness": 30.0, "upper": 0.4, "lower": -0.45, "damping_time": 3e-3}, 0.1),
    ("kinematic_error", elastic_joint, {"amplitude": 0.01, "phase": 0.6}, 0.1),
    ("stiffening", elastic_joint, {"knee": 0.06}, 0.05),
    ("servo_gain", servo, {"factor": 0.7}, 0.05),
    ("supply_sag", servo, {"resistance": 2.0}, 0.1),
    ("fixture_compliance", damped_pendulum, {"stiffness": 60.0, "inertia": 0.03, "damping_time": 2e-3}, 0.1),
]


@pytest.mark.parametrize(("effect", "machine", "truth", "accuracy"), CASES, ids=[case[0] for case in CASES])
def test_an_effect_is_recovered_from_its_own_recordings(effect, machine, truth, accuracy):
    arm = machine()
    hidden = arm.with_effect(effect, **truth)
    if "link.inertia" not in arm.fixed:
        hidden = hidden.with_values({"link.inertia": 1.05 * arm.value("link.inertia")})
    runs = [simulate(hidden, input, duration=5.0, rate=200.0, seed=seed) for seed, input in enumerate(("square", "sweep"))]
    found = add(effect, arm, runs, jobs=1)
    assert found.error["final"] < 1.15
    for key, value in truth.items():
        assert found.arm.effects[effect][key] == pytest.approx(value, rel=accuracy), key


def test_a_servo_s_gears_show_their_compliance_without_a_tachometer():
    arm = servo(proportional=3000.0).with_effect("viscous", coefficient=0.004)
    arm = arm.with_values({"link.tilt": 0.0, "drive.limit": 0.5})
    hidden = arm.with_effect("gear_compliance", stiffness=40.0, damping_time=1e-3)
    runs = [simulate(hidden, input, duration=4.0, rate=500.0, seed=seed) for seed, input in enumerate(("square", "pulse"))]
    found = add("gear_compliance", arm, runs, jobs=1)
    assert found.error["final"] < 1.15
    resonance = [one.linearise("moving", 0.002).vibrations()[0][-1] for one in (hidden, found.arm)]
    assert resonance[1] == pytest.approx(resonance[0], rel=0.02)
