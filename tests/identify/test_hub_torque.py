"""The torque on the hub that recordings ask for, against the law that made them, and the effects' own curves."""

from __future__ import annotations

import numpy as np
import pytest
import rig

from benchmarks.machines.cases import case
from flexarm_env import Arm, Recording
from flexarm_env.effects import catalogue
from flexarm_env.identify.explain.effect_curve import driver_of, effect_curve, unexplained_curve
from flexarm_env.identify.explain.hub_torque import acts_on_hub, hub_torque, law_torque
from flexarm_env.identify.replay.dataset import prepare


def recorded(settings: dict[str, float], experiment: str, seed: int = 3) -> Recording:
    """A recording by the independent rig."""
    made = rig.simulate(settings, experiment, seed=seed, duration=6.0)
    signals = {name: made[name] for name in ("arm_angle", "motor_speed", "strain_mid", "strain_base")}
    return Recording.from_arrays(experiment, made["time"], "current", made["current"], signals)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


@pytest.fixture(scope="module")
def with_stribeck() -> list[Recording]:
    return [recorded({"stribeck": 0.15, "vs": 0.3}, name) for name in ("square", "sweep")]


def test_friction_is_found_without_its_law(arm, with_stribeck):
    for one in hub_torque(arm, with_stribeck):
        moving = np.abs(one.speed) > 0.1
        speed = one.speed[moving]
        friction = np.sign(speed) * (0.282 + 0.15 * np.exp(-((speed / 0.3) ** 2))) + 0.1018 * speed
        off = -one.torque[moving] - friction
        assert np.median(np.abs(off)) < 0.02
        assert abs(np.median(off)) < 0.01


def test_an_effect_s_curve_holds_the_data_against_the_fitted_law(arm, with_stribeck):
    true = arm.with_effect("stribeck", extra=0.15, falloff_speed=0.3)
    curve = effect_curve(arm, true, "stribeck", prepare(arm, with_stribeck)[1])
    assert (curve.driver, curve.quantity) == ("speed", "friction")
    fast = np.abs(curve.bins) > 0.1
    fitted = np.interp(curve.bins[fast], curve.line, curve.fitted)
    assert np.abs(curve.middle[fast] - fitted).max() < 0.04
    assert np.mean((curve.low[fast] <= fitted) & (fitted <= curve.high[fast])) > 0.6
    slow = np.abs(np.abs(curve.line) - 0.15) < 0.02
    assert np.abs(curve.fitted - curve.given)[slow].min() > 0.1


def test_what_depends_on_the_angle_is_shown_against_it(arm):
    recordings = [recorded({"cable": 0.15, "cable0": 0.1}, name) for name in ("square", "sweep")]
    true = arm.with_effect("cable_stiffness", stiffness=0.15, rest_angle=0.1)
    curve = effect_curve(arm, true, "cable_stiffness", prepare(arm, recordings)[1])
    assert curve.driver == "angle"
    slope, start = np.polyfit(curve.bins, curve.middle, 1)
    assert slope == pytest.approx(-0.15, abs=0.03)
    assert start == pytest.approx(0.15 * 0.1, abs=0.02)
    assert np.allclose(curve.fitted, -0.15 * (curve.line - 0.1))
    assert np.all(curve.given == 0.0)
    left = unexplained_curve(arm, "angle", prepare(arm, recordings)[1])
    assert np.polyfit(left.bins, left.middle, 1)[0] == pytest.approx(slope, abs=1e-9)


def test_what_does_not_act_on_the_hub_has_no_such_curve(arm, with_stribeck):
    assert effect_curve(arm, arm.with_effect("backlash"), "backlash", prepare(arm, with_stribeck)[1]) is None
    still = with_stribeck[0]
    zeros = {name: np.zeros(len(still)) for name in still.signals}
    nothing = Recording.from_arrays("still", still.time, "current", np.zeros(len(still)), zeros)
    assert unexplained_curve(arm, "speed", prepare(arm, [nothing])[1]) is None


@pytest.mark.parametrize(
    "name",
    [n for n, e in catalogue().items() if e.port("friction") or e.port("factor") or e.port("torque")]
    + ["viscous", "cable_stiffness"],
)
def test_every_effect_on_the_hub_has_a_driver_and_a_law(arm, name):
    changed = arm.with_effect(name)
    if name in ("load_friction", "back_driving"):  # which take the torque in the gears besides
        assert not acts_on_hub(changed, name)
        return
    assert acts_on_hub(changed, name)
    assert driver_of(changed, name) in ("speed", "angle", "time")
    points = np.linspace(0.1, 2.0, 7)
    torque = law_torque(changed, [name], points, points, points)
    assert np.isfinite(torque).all()
    if changed.known[name].port("friction") or changed.known[name].port("factor"):
        against = law_torque(changed, [name], points, -points, points)
        directed = {"asymmetric_coulomb", "asymmetric_viscous"} & {name}
        assert np.allclose(against, torque if directed else -torque)


@pytest.mark.parametrize(
    ("name", "values", "angle", "speed", "torque"),
    [
        ("viscous", {"coefficient": 0.1}, 0.0, 2.0, -0.2),
        ("viscous", {"coefficient": 0.1}, 0.0, -2.0, 0.2),
        ("coulomb", {"torque": 0.3}, 0.0, 2.0, -0.3),
        ("coulomb", {"torque": 0.3}, 0.0, -2.0, 0.3),
        ("stiction", {"extra": 0.3}, 0.0, -2.0, 0.0),
        ("stribeck", {"extra": 2.0, "falloff_speed": 0.5}, 0.0, -0.5, 2.0 / np.e),
        ("asymmetric_coulomb", {"torque": 0.2}, 0.0, 2.0, -0.2),
        ("asymmetric_coulomb", {"torque": 0.2}, 0.0, -2.0, -0.2),
        ("asymmetric_viscous", {"coefficient": 0.2}, 0.0, -2.0, -0.4),
        ("position_friction", {"amplitude": 2.0, "cycles": 3.0, "phase": 0.0}, np.pi / 6, -1.0, 2.0),
        ("cable_stiffness", {"stiffness": 0.5, "rest_angle": 0.2}, 1.0, 1.0, -0.4),
        ("constant_torque", {"torque": -0.05}, 1.0, 1.0, -0.05),
        ("base_tilt", {"torque": 2.0, "uphill": 0.0}, np.pi / 6, -1.0, 1.0),
        ("cogging", {"amplitude": 2.0, "cycles": 3.0, "phase": 0.0}, np.pi / 6, -1.0, 2.0),
        ("end_stop", {"stiffness": 10.0, "upper": 1.0, "lower": -1.0, "damping_time": 0.1}, 1.5, 1.0, -6.0),
        ("end_stop", {"stiffness": 10.0, "upper": 1.0, "lower": -1.0, "damping_time": 0.1}, 1.5, -1.0, -4.0),
    ],
)
def test_the_torque_of_a_law_by_hand(arm, name, values, angle, speed, torque):
    found = law_torque(arm.with_effect(name, **values), [name], *np.array([[angle], [speed], [3.0]]))
    assert found == pytest.approx([torque], abs=1e-12)


def test_warming_friction_is_a_share_of_all_dry_friction(arm):
    warm = arm.with_effect("coulomb", torque=0.3).with_effect("friction_warmup", share=0.4, time_constant=10.0)
    points = np.array([0.0, 0.0]), np.array([2.0, -2.0]), np.full(2, 10.0 * np.log(2.0))  # half of the share is lost
    assert law_torque(warm, ["friction_warmup"], *points) == pytest.approx([0.06, -0.06])
    assert law_torque(warm, ["coulomb", "friction_warmup"], *points) == pytest.approx([-0.24, 0.24])


def test_a_machine_of_a_few_grams_has_a_smoother():
    small = case(4, 27)  # its states differ by so many decades that an ordered Schur form does not exist
    motions = hub_torque(small.arm, small.recordings)
    assert motions
    assert all(np.isfinite(one.torque).all() for one in motions)
