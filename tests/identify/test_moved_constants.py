"""A constant that a fit moves far from its prior is told, as of a motor whose datum is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, fit, simulate


def turned(factor: float) -> list[Recording]:
    """Record a rigid axis whose hub has a multiple of the stated inertia."""
    arm = Arm.load("cu-rigid")
    true = arm.with_values({"hub.inertia": factor * arm.value("hub.inertia")})
    return [simulate(true, "pulse", duration=4.0, rate=200.0, seed=1)]


@pytest.mark.parametrize(("factor", "told"), [(1.1, False), (4.0, True)])
def test_a_constant_that_moved_far_from_its_prior_is_told(factor, told):
    arm = Arm.load("cu-rigid")
    found = fit(arm, turned(factor), jobs=1)
    notes = [note for note in found.notes if note.startswith("hub.inertia moved by ")]
    assert bool(notes) == told
    if told:
        times = float(notes[0].split("moved by ")[1].split()[0])
        after = next(e.value for e in found.estimates if e.path == "hub.inertia")
        assert times == pytest.approx(np.log(after / arm.value("hub.inertia")) / arm.parameter("hub.inertia").spread, abs=0.06)
        assert f"→ {after:.3g} kg" in notes[0]
