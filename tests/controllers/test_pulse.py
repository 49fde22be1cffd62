"""What docs/policies.md says of a command that just breaks a stuck hub loose: held for 20 ms, or sent for 5 ms."""

from __future__ import annotations

import numpy as np
import pytest
from controllers.loop import INTERVAL, close

from flexarm_env.controllers import make_controller

#: Just above break-away: 0.358 Nm over 0.495 Nm/A are 0.723 A.
COMMAND = 0.73


@pytest.mark.parametrize(("samples", "turn_deg", "strain_volt"), [(4, 0.08, 0.08), (1, 0.009, 0.011)])
def test_a_pulse_is_finer_than_a_held_command(thesis, samples, turn_deg, strain_volt):
    idle = make_controller("pd", thesis, INTERVAL, proportional=0.0, derivative=0.0)
    feed = np.zeros(200)
    feed[:samples] = COMMAND
    truth = close(thesis, idle, np.zeros(200), noise=False, feed=feed).truth
    assert np.rad2deg(truth[-1, 0]) == pytest.approx(turn_deg, rel=0.1)
    assert np.abs(truth[samples:, 2]).max() == pytest.approx(strain_volt, rel=0.1)
