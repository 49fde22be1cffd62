"""Two runs in one file."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, inspect_recordings
from tests.identify.inspect.faulty import changed, only


@pytest.mark.parametrize("pause", [0.002, 0.5])
def test_two_runs_in_one_file(thesis, pulse, square, pause):
    start = pulse.duration + pause
    signals = {name: np.r_[values, square.signals[name]] for name, values in pulse.signals.items()}
    time, command = np.r_[pulse.time, start + square.time], np.r_[pulse.command, square.command]
    fault = only(thesis, Recording.from_arrays("both", time, "current", command, signals))
    assert (fault.kind, fault.signal, fault.rows) == ("glued", "", (len(pulse),))
    assert fault.value == pytest.approx(start)
    assert "cut it there" in fault.message


def test_runs_that_end_a_turn_apart_are_two_and_no_wrap():
    arm = Arm.load("cu-rigid")
    time = np.arange(0.0, 2.0, 0.004)
    noise = np.random.default_rng(1).normal(0.0, 5e-4, 2 * len(time))
    angle = 0.5 * 6.2 * (1.0 - np.cos(np.pi * np.minimum(time, 1.0)))
    both = np.r_[angle, 0.3 * angle] + noise
    command = np.tile(np.sin(np.pi * time), 2)
    run = Recording.from_arrays("both", np.arange(len(both)) * 0.004, "voltage", command, {"arm_angle": both})
    fault = next(one for one in inspect_recordings(arm, [run]).faults)
    assert (fault.kind, fault.rows) == ("glued", (len(time),))


def test_an_angle_whose_encoder_slips_is_not_two_runs(thesis, square):
    """One signal jumps, while the others go on in motion."""
    row = int(np.abs(square.signals["motor_speed"]).argmax())
    angle = square.signals["arm_angle"] + np.where(np.arange(len(square)) >= row, 0.3, 0.0)
    assert [fault.kind for fault in inspect_recordings(thesis, [changed(square, "arm_angle", angle)]).faults] == []


def test_a_gap_in_a_motion_is_not_two_runs(thesis, square):
    """A logger that lost half a second while the arm moved: every signal has changed meanwhile."""
    start = int(np.abs(square.signals["motor_speed"]).argmax())
    kept = np.r_[np.arange(start), np.arange(start + 250, len(square))]
    signals = {name: values[kept] for name, values in square.signals.items()}
    run = Recording.from_arrays("gap", square.time[kept], "current", square.command[kept], signals)
    assert inspect_recordings(thesis, [run]).faults == ()
    absent = {name: np.where(np.isin(np.arange(len(square)), kept), values, np.nan) for name, values in square.signals.items()}
    assert inspect_recordings(thesis, [replace(square, signals=absent)]).faults == ()
