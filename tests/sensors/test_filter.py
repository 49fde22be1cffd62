"""A sensor's filter against its own equation, through the stops of the hub."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, simulate
from flexarm_env.arm_file import shipped_arms

RATE, LAG = 2000.0, 0.01


def lagged(readings: np.ndarray) -> np.ndarray:
    """Filter readings by a first-order lag, between samples along straight lines."""
    found, step = np.zeros_like(readings), 1.0 / RATE
    decay = np.exp(-step / LAG)
    for i in range(1, len(readings)):
        slope = (readings[i] - readings[i - 1]) / step
        found[i] = decay * found[i - 1] + (1.0 - decay) * readings[i - 1] + slope * (step - LAG * (1.0 - decay))
    return found


@pytest.mark.parametrize("name", sorted(shipped_arms()))
def test_a_filtered_angle_goes_on_where_the_hub_stops(name):
    arm = Arm.load(name)
    plain, filtered = (
        simulate(arm.with_values({"sensors.arm_angle.filter": lag}), "pulse", duration=1.0, rate=RATE, noise=False)
        for lag in (0.0, LAG)
    )
    angle = plain.signals["arm_angle"]
    assert np.abs(np.diff(angle)).max() > 0.0
    error = filtered.signals["arm_angle"] - lagged(angle)
    # Straight lines miss a parabola by an eighth of its second difference.
    assert np.abs(error).max() < np.abs(np.diff(angle, 2)).max() + 1e-12
