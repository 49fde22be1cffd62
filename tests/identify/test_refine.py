"""The last steps of a calibration end, whatever the strengths of what they see."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env.identify.calibrate.least_squares import one_by_one
from flexarm_env.identify.calibrate.refine import gauss_newton
from flexarm_env.identify.settings import SETTINGS


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("scale", [1e3, 1e9, 1e12])
def test_steps_end_where_values_are_seen_together_alone(seed, scale):
    """Rounding makes the least strength of two values that act alike negative."""
    draw = np.random.default_rng(seed)
    seen = scale * draw.standard_normal((60, 4))
    seen[:, 3] = seen[:, 0] + seen[:, 1] + 1e-9 * seen[:, 2]
    wanted, calls = draw.standard_normal(60), [0]

    def residual(x):
        calls[0] += 1
        assert calls[0] < 2000, "the steps do not end"
        return seen @ x - wanted

    found = gauss_newton(one_by_one(residual), 1e-3 * np.ones(4) / scale, np.ones(4), SETTINGS.refining)
    best = np.linalg.lstsq(seen, wanted, rcond=1e-7)[0]
    assert found.cost <= 1.01 * np.sum((seen @ best - wanted) ** 2) + 1e-6
