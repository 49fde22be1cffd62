"""The vibrations that replays keep where they follow the readings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.vibrations import count_vibrations
from flexarm_env.identify.settings import SETTINGS


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


@pytest.fixture(scope="module")
def pulse(arm) -> Recording:
    return simulate(arm, "pulse", duration=3.0, rate=500.0, seed=1)


def test_what_is_left_out_moves_no_reading_by_much(arm, pulse):
    _, data = prepare(arm, [pulse])
    assert 0 < data.vibrations < 12
    played = []
    for reduced in (False, True):
        (plant,) = data.plants(arm, reduced).values()
        plant.place()
        played.append(plant.replay(data.runs[0].command[:500]))
    off = np.sqrt(np.mean(((played[1] - played[0]) / data.noise) ** 2, axis=0))
    assert off.max() < 2.0 * SETTINGS.thinning.vibration_error


def test_finer_sensors_need_more_vibrations(arm, pulse):
    _, data = prepare(arm, [pulse])
    counts = [count_vibrations(arm, data.runs, data.interval, share * data.noise, SETTINGS) for share in (30.0, 1.0, 0.2)]
    assert counts == sorted(counts)
    assert counts[0] < counts[-1]
    assert count_vibrations(arm, data.runs, data.interval, 1e-9 * data.noise, SETTINGS) == 0


def test_an_arm_without_a_beam_has_none():
    rigid = Arm.load("cu-rigid")
    _, data = prepare(rigid, [simulate(rigid, "square", duration=2.0, rate=100.0, seed=1)])
    assert data.vibrations == 0


def test_free_replays_have_the_whole_beam(arm, pulse):
    _, data = prepare(arm, [pulse])
    (whole,), (reduced,) = (data.plants(arm, one).values() for one in (False, True))
    assert whole.blocks == arm.plant(data.interval).blocks > reduced.blocks


def test_a_payload_that_recordings_state_is_in_their_plants(arm, pulse):
    loaded = replace(pulse, name="loaded", conditions={"payload": 0.2})
    _, data = prepare(arm, [pulse, loaded])
    assert len(data.plants(arm, reduced=True)) == 2
