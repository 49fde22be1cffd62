"""A limited rate against the closed form: a free hub moves as the ramp's current drives it."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm
from flexarm_env.plant.flat_arrays import RAMP_PARTS

INTERVAL, FINE = 0.002, 400
#: A step each way, [A], and when the second comes, [s].
FIRST, SECOND, SWITCH = 5.0, -3.0, 0.08
COMMANDS = np.repeat([FIRST, SECOND], [40, 60])


def current_at(time, rate):
    """The current [A] that follows the commands at a rate [A/s] of 62.5 A/s at least."""
    falling = np.maximum(FIRST - rate * (time - SWITCH), SECOND)
    return np.where(time < SWITCH, np.minimum(rate * time, FIRST), falling)


@pytest.mark.parametrize("rate", [100.0, 390.0, 1971.0, 5500.0])
def test_a_free_hub_moves_as_the_ramp_drives_it(rate):
    free = Arm.load("emps").without_effect("viscous").without_effect("coulomb").without_effect("constant_torque")
    angle = free.with_effect("rate_limit", rate=rate).plant(INTERVAL).replay(COMMANDS)[:, 0]
    per_ampere = free.constants["drive"]["torque_constant"] / free.constants["hub"]["inertia"]
    fine = INTERVAL / FINE
    middle = (np.arange(FINE * len(COMMANDS)) + 0.5) * fine
    gained = per_ampere * fine * current_at(middle, rate)
    speed = np.concatenate([[0.0], np.cumsum(gained)])
    expected = np.concatenate([[0.0], np.cumsum(fine * (speed[:-1] + speed[1:]) / 2.0)])[::FINE][: len(angle)]
    # Twice integrated over h, what lies within a range r h of its mean comes to r h³/8 at most.
    changes, part = FIRST + abs(SECOND - FIRST), INTERVAL / RAMP_PARTS
    bound = per_ampere * (changes + 2.0 * rate * part) * part**2 / 8.0
    assert np.abs(angle - expected).max() < bound
    assert np.diff(angle)[-1] == pytest.approx(np.diff(expected)[-1], rel=1e-5)


@pytest.mark.parametrize("rate", [0.0, 1e-200, 1e-12, 1e-3])
def test_a_hub_under_a_rate_near_zero_moves_as_the_integral_does(rate):
    free = Arm.load("emps").without_effect("viscous").without_effect("coulomb").without_effect("constant_torque")
    angle = free.with_effect("rate_limit", rate=rate).plant(INTERVAL).replay(np.full(100, FIRST))[:, 0]
    per_ampere = free.constants["drive"]["torque_constant"] / free.constants["hub"]["inertia"]
    time = INTERVAL * np.arange(len(angle))
    # The mean of a ramp over each part of a sample misses its integral in the first few samples alone.
    assert angle[10:] == pytest.approx((per_ampere * rate * time**3 / 6.0)[10:], rel=1e-2, abs=0.0)
