"""Recordings that move unlike the model: one signal alone, a swing against it, a model that rests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording, inspect_recordings
from flexarm_env.rigs.table import RIGS


@pytest.mark.parametrize("speed", [2.1, 2.2])
def test_a_free_swing_against_that_of_the_model_is_no_factor_of_its_speed(speed):
    """Without an angle the model falls from where its angle is zero, upright here. No factor of a torque of zero mends that."""
    arm = Arm.from_table(
        {
            "drive": {"input": "torque", "limit": 0.1},
            "link": {"mass": 0.15, "centre": 0.15, "inertia": 0.0035, "vertical": True, "hangs_at": np.pi},
            "sensors": {"motor_speed": {"noise": 0.02}},
        },
        "pendulum",
    )
    plant, time = arm.plant(0.004), 0.004 * np.arange(1500)
    plant.place(np.array([np.pi - 0.3, speed]))
    readings = plant.replay(np.zeros(len(time)))[:, 0] + 0.02 * np.random.default_rng(0).normal(size=len(time))
    swing = Recording.from_arrays("swing", time, "torque", np.zeros(len(time)), {"motor_speed": readings})
    assert inspect_recordings(arm, [swing]).faults == ()


@pytest.mark.parametrize("rig", [rig for rig in RIGS if rig.name != "xl330"], ids=lambda rig: rig.name)  # of one signal as it is
def test_any_signal_alone_of_a_real_rig_is_inspected(rig, measurements):
    arm = Arm.load(rig.arm)
    for record in (*rig.training, *rig.held_out):
        recording = record.read(measurements, arm)
        for signal, readings in recording.signals.items():
            inspected = inspect_recordings(arm, [replace(recording, signals={signal: readings})])
            assert [facts.signal for facts in inspected.signals] == [signal]


def test_a_late_speed_beside_commands_of_zero_keeps_the_lag_that_the_angle_shows(thesis, pulse):
    """The model rests there: it says nothing of a lag."""
    speed = np.roll(pulse.signals["motor_speed"], 300)
    late = replace(pulse, command=np.zeros_like(pulse.command), signals=pulse.signals | {"motor_speed": speed})
    assert "clock" in {fault.kind for fault in inspect_recordings(thesis, [late]).faults}
