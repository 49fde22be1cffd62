"""The two arms on which controllers are tried."""

from __future__ import annotations

import pytest

from flexarm_env.arm import Arm


@pytest.fixture(scope="session")
def thesis() -> Arm:
    return Arm.load("thesis")


@pytest.fixture(scope="session")
def fine() -> Arm:
    return Arm.load("thesis-fem")


@pytest.fixture(params=["thesis", "thesis-fem"])
def arm(request) -> Arm:
    return Arm.load(request.param)
