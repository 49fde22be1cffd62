"""Recordings that do not start at rest: an arm that is known must meet them from their first sample on."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, compare, simulate
from flexarm_env.identify.start import find_start

PULSE_ENDS = 1.0  # [s], of simulate's first pulse
NOISE = np.array([2e-3, 0.03, 1e-2, 1e-2])
SIGNALS = ["arm_angle", "motor_speed", "strain_mid", "strain_base"]


def cut(recording: Recording, first: float, signals: list[str] | None = None) -> Recording:
    later = recording.time >= first
    kept = {name: values[later] for name, values in recording.signals.items() if signals is None or name in signals}
    return Recording.from_arrays(
        recording.name, recording.time[later] - recording.time[later][0], recording.input_kind, recording.command[later], kept
    )


def error(arm: Arm, recording: Recording) -> float:
    rows = compare(arm, [recording]).rows
    return max(row.free_run for row in rows if row.part == "all")


@pytest.mark.parametrize("name", ["thesis", "thesis-fem"])
@pytest.mark.parametrize("first", [0.7, 0.95, 2.4])  # driven, driven at speed, stuck and vibrating
def test_a_known_arm_is_met_from_wherever_the_recording_starts(name: str, first: float) -> None:
    arm = Arm.load(name)
    recording = cut(simulate(arm, "pulse", duration=3.0), first)
    assert error(arm, recording) < 1.8


def test_the_speed_at_the_start_is_found_without_a_tachometer() -> None:
    arm = Arm.load("thesis")
    recording = cut(simulate(arm, "pulse", duration=3.0), 0.9, ["arm_angle", "strain_base"])
    assert error(arm, recording) < 1.8


def test_an_arm_that_is_driven_at_once_starts_at_rest() -> None:
    time = np.arange(200) / 500.0
    measured = np.column_stack([4.0 * time**2, 12.0 * time, 2.0 * (1.0 - np.cos(60.0 * time)), 3.0 * (1.0 - np.cos(60.0 * time))])
    start = find_start(time, measured, SIGNALS, NOISE)
    assert (start.angle, start.speed, start.moving, start.vibrating) == (0.0, 0.0, False, False)


def test_an_offset_of_a_gage_is_no_vibration() -> None:
    time = np.arange(200) / 500.0
    draw = np.random.default_rng(0)
    measured = NOISE * draw.standard_normal((200, 4)) + np.array([0.5, 0.0, 0.3, -0.2])
    start = find_start(time, measured, SIGNALS, NOISE)
    assert start.angle == pytest.approx(0.5, abs=1e-3)
    assert not start.moving
    assert not start.vibrating
