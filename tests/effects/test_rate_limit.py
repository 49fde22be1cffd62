"""A limited rate against the closed form: a free hub gains in each sample the impulse of the ramp."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm

INTERVAL, FINE = 0.002, 400
#: A step each way, [A], and when the second comes, [s].
FIRST, SECOND, SWITCH = 5.0, -3.0, 0.08
COMMANDS = np.repeat([FIRST, SECOND], [40, 60])


def current_at(time, rate):
    """The current [A] that follows the commands at a rate [A/s] of 62.5 A/s at least."""
    falling = np.maximum(FIRST - rate * (time - SWITCH), SECOND)
    return np.where(time < SWITCH, np.minimum(rate * time, FIRST), falling)


@pytest.mark.parametrize("rate", [100.0, 390.0, 1971.0, 5500.0])
def test_a_free_hub_gains_the_impulse_of_the_ramp(rate):
    free = Arm.load("emps").without_effect("viscous").without_effect("coulomb").without_effect("constant_torque")
    angle = free.with_effect("rate_limit", rate=rate).plant(INTERVAL).replay(COMMANDS)[:, 0]
    middle = (np.arange(FINE * len(COMMANDS)) + 0.5) * INTERVAL / FINE
    mean = current_at(middle, rate).reshape(-1, FINE).mean(axis=1)
    gain = free.constants["drive"]["torque_constant"] / free.constants["hub"]["inertia"] * INTERVAL**2 / 2.0
    assert np.diff(angle, 2) == pytest.approx(gain * (mean[:-1] + mean[1:])[: len(angle) - 2], abs=1e-4 * gain)
