"""Sound recordings that tests put faults into."""

from __future__ import annotations

import pytest

from flexarm_env import Arm, Recording, simulate


@pytest.fixture(scope="session")
def thesis() -> Arm:
    return Arm.load("thesis")


@pytest.fixture(scope="session")
def square(thesis) -> Recording:
    """The thesis's arm under a PD controller, 6 s at 500 Hz."""
    return simulate(thesis, "square", duration=6.0, seed=3)


@pytest.fixture(scope="session")
def pulse(thesis) -> Recording:
    """The thesis's arm under pulses, 6 s at 500 Hz."""
    return simulate(thesis, "pulse", duration=6.0, seed=3)
