"""The quintic reference, and the laws that follow one, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from controllers.loop import INTERVAL, SLEW, frictionless, loaded, slew

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.lqg import LQG, LQGDesign
from flexarm_env.controllers.pid import CompensatedPID
from flexarm_env.controllers.reference import QuinticReference
from flexarm_env.linear import linearise


def path(targets, speed=2.0, acceleration=8.0, interval=1e-3):
    reference = QuinticReference(speed, acceleration, interval)
    reference.start(1)
    return np.array([np.concatenate(reference.update(np.zeros(1), np.array([target]))) for target in targets])


@pytest.mark.parametrize(("way", "speed", "acceleration"), [(1.7, 2.0, 1e3), (1.7, 1e3, 8.0), (-0.3, 2.0, 8.0)])
def test_a_move_from_rest_keeps_the_limits_and_reaches_one_of_them(way, speed, acceleration):
    seen = path(np.full(4000, way), speed, acceleration)
    fastest, strongest = np.abs(seen[:, 1]).max(), np.abs(seen[:, 2]).max()
    assert max(fastest / speed, strongest / acceleration) == pytest.approx(1.0, rel=1e-3)
    np.testing.assert_array_equal(seen[-1], [way, 0.0, 0.0])
    # minimum jerk: 10 τ³ − 15 τ⁴ + 6 τ⁵
    duration = max(1.875 * abs(way) / speed, np.sqrt(10.0 / np.sqrt(3.0) * abs(way) / acceleration))
    share = np.minimum(1e-3 * np.arange(1, 4001) / duration, 1.0)
    np.testing.assert_allclose(seen[:, 0], way * share**3 * (10.0 - 15.0 * share + 6.0 * share**2), atol=1e-12)


def test_a_new_target_on_the_way_leaves_angle_speed_and_acceleration_continuous():
    targets = np.concatenate([np.full(300, 1.0), np.full(3000, -0.5)])
    seen = path(targets)
    # trapezoids: the angle is the integral of the speed, and the speed that of the acceleration
    for lower, higher in ((0, 1), (1, 2)):
        change = np.diff(seen[:, lower])
        np.testing.assert_allclose(change, 0.5e-3 * (seen[1:, higher] + seen[:-1, higher]), atol=2e-5)
    assert np.abs(np.diff(seen[:, 2])).max() < 0.3
    np.testing.assert_array_equal(seen[-1], [-0.5, 0.0, 0.0])


def test_the_gains_of_the_pid_place_the_poles_of_a_rigid_arm():
    arm = Arm.load("cu-rigid").with_values({"drive.limit": 5.0})
    law = CompensatedPID(arm, 0.001, {"bandwidth": 7.0, "damping": 0.6, "integral": 0.3})
    model = linearise(arm, "moving", 0.001)
    push, friction = model.forcing[model.states.index("hub_rate"), 0], -model.dynamics[1, 1]
    assert law.inertia == pytest.approx(1.0 / push, rel=1e-9)
    found = np.roots([1.0, friction + push * law.derivative, push * law.proportional, push * law.integral])
    wanted = np.append(np.roots([1.0, 2.0 * 0.6 * 7.0, 49.0]), -0.3 * 7.0)
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(wanted), rtol=1e-6)


@pytest.mark.parametrize("name", ["pid_compensated", "mpc"])
@pytest.mark.parametrize("mass", [0.0, 0.2])
def test_both_settle_on_the_thesis_s_arm(thesis, name, mass):
    if name == "mpc":
        pytest.importorskip("daqp")
    run = slew(loaded(thesis, mass), make_controller(name, thesis, INTERVAL))
    assert run.settled(1.0) < 5.0
    assert np.abs(run.error[-100:]).max() < 1.0


def test_mpc_within_the_limit_is_the_regulator(thesis):
    """With the regulator's cost to go and a horizon of one sample, the plan is −K e."""
    pytest.importorskip("daqp")
    arm = frictionless(thesis)
    both = [
        make_controller(name, arm, INTERVAL, design=design)
        for name, design in (("mpc", {"horizon": INTERVAL}), ("lqg_scheduled", {}))
    ]
    seen = 1e-3 * np.random.default_rng(0).normal(size=(200, 5))
    for law in both:
        law.reset()
    found = np.array([[float(law.act(one)) for law in both] for one in seen])
    assert np.abs(found).max() < 5.0
    np.testing.assert_allclose(found[:, 0], found[:, 1], atol=1e-9)


def test_mpc_beyond_the_limit_solves_its_program(thesis):
    """The first-order conditions: the gradient vanishes, or points out of the box."""
    pytest.importorskip("daqp")
    law = make_controller("mpc", thesis, INTERVAL)
    law.reset()
    program = law._programs[0]
    distance = -SLEW * program.rest
    plan = law._limited(program, distance, -1.0, 1.0)
    gradient = program.hessian @ plan + program.force @ distance
    scale = np.abs(program.force @ distance).max()
    assert (np.abs(plan) <= 1.0 + 1e-9).all()
    assert plan[0] == pytest.approx(1.0, abs=1e-9)
    assert (gradient[plan >= 1.0 - 1e-9] < 1e-9 * scale).all()
    assert (gradient[plan <= -1.0 + 1e-9] > -1e-9 * scale).all()
    assert (np.abs(gradient[np.abs(plan) < 1.0 - 1e-9]) < 1e-6 * scale).all()


def test_a_dead_time_in_the_design_makes_up_for_that_of_the_drive(thesis):
    """The estimate, moved on through the commands on their way, is that of a drive without a dead time."""
    arm = frictionless(thesis)
    late = arm.with_effect("input_delay", delay=2 * INTERVAL)
    sharp = {"angle": 0.03, "speed": 0.3, "tip_speed": 0.5, "deflection": 0.05}
    told, untold = (slew(late, LQG(arm, INTERVAL, LQGDesign(**sharp, dead_time=d)), noise=False) for d in (2 * INTERVAL, 0.0))
    assert told.residual() < 0.2 * untold.residual()
    assert abs(told.error[-1]) < 0.1


def test_a_lower_order_keeps_the_slowest_motion(fine):
    from flexarm_env.controllers.slow import slow_part

    whole, less = slow_part(fine, INTERVAL, 48.0), slow_part(fine, INTERVAL, 48.0, order=4)
    assert len(less.transition) == 4 < len(whole.transition)
    kept = np.sort_complex(np.linalg.eigvals(less.transition))
    every = np.linalg.eigvals(whole.transition)
    for value in kept:
        assert np.abs(every - value).min() < 1e-9
