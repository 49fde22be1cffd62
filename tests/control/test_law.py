"""A control law as it runs: against its equation, computed over whole arrays."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from flexarm_env.control.law import ControlLaw, Feedback

INTERVAL = 0.002
TIME = np.arange(500) * INTERVAL
REFERENCE = np.where(TIME > 0.3, 0.5, -0.5)
ANGLE = 0.4 * np.sin(5.0 * TIME) + 0.1
SPEED = 3.0 * np.cos(7.0 * TIME)


def run(law: ControlLaw, *signals: np.ndarray, reference: np.ndarray = REFERENCE) -> np.ndarray:
    running = law.start(INTERVAL, [values[0] for values in signals])
    return np.array([running.command(row, r) for *row, r in zip(*signals, reference, strict=True)])


def test_proportional_feedback_of_several_signals_is_a_sum():
    law = ControlLaw((Feedback("arm_angle", (3.0, 2.0)), Feedback("motor_speed", (0.5,))))
    assert run(law, ANGLE, SPEED) == pytest.approx(6.0 * (REFERENCE - ANGLE) - 0.5 * SPEED, rel=1e-12, abs=1e-12)


def test_the_command_is_limited():
    commands = run(ControlLaw((Feedback("arm_angle", (6.0,)),), limit=2.0), ANGLE)
    assert commands == pytest.approx(np.clip(6.0 * (REFERENCE - ANGLE), -2.0, 2.0), abs=1e-12)
    assert commands.max() == 2.0


def test_the_integral_adds_up_errors_before_the_present_one():
    commands = run(ControlLaw((Feedback("arm_angle", integral=(4.0,)),)), ANGLE)
    sums = np.concatenate([[0.0], np.cumsum(REFERENCE - ANGLE)[:-1]])
    assert commands == pytest.approx(4.0 * INTERVAL * sums, abs=1e-12)


def test_the_slope_is_taken_over_its_span():
    """Over two periods it is the backward difference of the mean of two samples."""
    commands = run(ControlLaw((Feedback("arm_angle", derivative=(1.0,), derivative_span=2 * INTERVAL),)), ANGLE)
    padded = np.concatenate([[ANGLE[0]] * 2, ANGLE])
    means = 0.5 * (padded[1:] + padded[:-1])
    assert commands == pytest.approx(-np.diff(means) / INTERVAL, abs=1e-9)


def test_filters_are_first_order_lags():
    tau = 0.01
    pole = tau / (tau + INTERVAL)
    law = ControlLaw(
        (Feedback("arm_angle", derivative=(1.0,), derivative_filter=tau), Feedback("motor_speed", (1.0,), filter=tau))
    )
    slopes = np.diff(ANGLE, prepend=ANGLE[0]) / INTERVAL
    slow, _ = lfilter([1 - pole], [1, -pole], slopes, zi=[0.0])
    speed, _ = lfilter([1 - pole], [1, -pole], SPEED, zi=[pole * SPEED[0]])
    assert run(law, ANGLE, SPEED) == pytest.approx(-slow - speed, abs=1e-9)


def test_a_slow_controller_holds_its_command_and_a_late_one_delays_it():
    error = 6.0 * (REFERENCE - ANGLE)
    held = run(ControlLaw((Feedback("arm_angle", (6.0,)),), rate=125.0), ANGLE)
    assert held == pytest.approx(np.repeat(error[::4], 4), abs=1e-12)
    late = run(ControlLaw((Feedback("arm_angle", (6.0,)),), delay=0.006), ANGLE)
    assert late == pytest.approx(np.concatenate([[0.0] * 3, error[:-3]]), abs=1e-12)


def test_a_slow_controller_takes_slopes_over_its_own_period():
    commands = run(ControlLaw((Feedback("arm_angle", derivative=(1.0,)),), rate=125.0), ANGLE)
    slopes = np.diff(ANGLE[::4], prepend=ANGLE[0]) / (4 * INTERVAL)
    assert commands == pytest.approx(np.repeat(-slopes, 4), abs=1e-9)


def test_a_law_that_starts_in_motion_has_the_slope_from_the_first_sample():
    law = ControlLaw((Feedback("arm_angle", derivative=(2.0,), derivative_span=0.01),))
    angle = 1.5 * TIME
    running = law.start(INTERVAL, [angle[0]], slopes=[1.5])
    assert [running.command([value], 0.0) for value in angle[:20]] == pytest.approx([-3.0] * 20)


def test_names_are_replaced_by_conditions():
    law = ControlLaw((Feedback("arm_angle", ("kp", "kv"), derivative=("kv",)),))
    assert law.conditions == ("kp", "kv")
    with pytest.raises(ValueError, match="kv"):
        law.with_conditions({"kp": 2.0}).start(INTERVAL, [0.0])
    stated = law.with_conditions({"kp": 2.0, "kv": 3.0, "other": 4.0})
    assert run(stated, np.zeros(3), reference=np.ones(3)) == pytest.approx([6.0] * 3)
