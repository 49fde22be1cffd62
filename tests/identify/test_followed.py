"""Which sines of the angle readings follow, and which they outrun."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flexarm_env import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.select.followed import follows_sine, turns_between_readings
from flexarm_env.identify.select.starts import candidates, starts_of
from flexarm_env.recordings.recording import Recording
from flexarm_env.thesis import tables

#: Two speeds of a motor [rad/s], and the time between its readings [s].
SLOW, FAST, INTERVAL = 1.0, 80.0, 0.5


def read_twice_a_second(speeds: list[float]) -> tuple[Arm, Dataset]:
    arm, _ = tables.experiment_2()
    shown = np.repeat(speeds, 60 // len(speeds))
    return prepare(arm, [Recording.from_arrays("turns", INTERVAL * np.arange(60), "current", shown, {"motor_speed": shown})])


@pytest.mark.parametrize(("cycles", "follows"), [(3.0, True), (6.0, True), (7.0, False), (30.0, False)])
def test_readings_follow_half_a_period_and_no_more(cycles: float, follows: bool):
    arm, dataset = read_twice_a_second([SLOW])
    assert turns_between_readings(arm, dataset) == pytest.approx(SLOW * INTERVAL)
    assert follows_sine(arm, cycles, dataset) is follows
    assert follows_sine(arm, math.inf, dataset)


def test_a_slow_part_of_a_motion_shows_what_a_fast_one_outruns():
    arm, dataset = read_twice_a_second([SLOW, FAST])
    assert follows_sine(arm, 6.0, dataset)
    assert not follows_sine(arm, 7.0, dataset)


def test_a_sine_that_readings_outrun_is_no_candidate():
    arm, dataset = prepare(*tables.experiment_2())
    assert starts_of(arm, "cogging", dataset) == starts_of(arm, "base_tilt", dataset) == []
    assert not {"cogging", "position_friction", "base_tilt"} & set(candidates(arm, dataset))
    assert "shear_thinning" in candidates(arm, dataset)


def test_a_swing_read_fast_enough_leaves_every_candidate():
    nominal = Arm.load("thesis")
    arm, dataset = prepare(nominal, [simulate(nominal, "square", duration=4.0)])
    assert {"cogging", "position_friction", "base_tilt", "pot_nonlinearity"} <= set(candidates(arm, dataset))
    travelled = np.abs(np.diff(dataset.runs[0].measured[:, dataset.signals.index("arm_angle")])).sum()
    assert turns_between_readings(arm, dataset).sum() == pytest.approx(travelled)
    assert len(starts_of(arm, "cogging", dataset)) == len(arm.known["cogging"].starts())
