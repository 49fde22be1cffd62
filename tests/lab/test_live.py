"""A changed arm is simulated through all recordings at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import flexarm_env
from flexarm_env import Arm, Recording, compare
from flexarm_env.lab.live import Live

DEMO = Path(flexarm_env.__file__).parent / "demo"


@pytest.fixture(scope="module")
def recordings() -> list[Recording]:
    return Recording.read_all(DEMO)


def test_it_shows_what_compare_computes(recordings):
    arm = Arm.load("thesis-fem").with_effect("backlash", gap=0.05)
    found, expected = Live(arm, recordings).simulate(arm), compare(arm, recordings)
    assert found.error == pytest.approx(expected.free_run, rel=1e-12)
    for one in expected.replays:
        assert np.array_equal(found.readings[one.name], np.column_stack(list(one.free.values())))
