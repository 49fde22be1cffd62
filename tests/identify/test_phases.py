"""Effects that repeat with the angle start from the phase that the recordings show."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.signatures import baseline, signatures

DRIVE = {"input": "torque", "limit": 4.0, "gear_ratio": 1.0}
SENSORS = {"arm_angle": {"resolution": 1e-4}, "motor_speed": {"noise": 0.02}}


@pytest.fixture(scope="module")
def axis() -> Arm:
    viscous = {"viscous": {"coefficient": 0.05}}
    return Arm.from_table({"drive": DRIVE, "hub": {"inertia": 0.02}, "effects": viscous, "sensors": SENSORS}, "axis")


@pytest.mark.parametrize("phase", [-2.4, -0.7, 0.8, 2.2])
@pytest.mark.parametrize("cycles", [9.0, 9.5])
def test_cogging_starts_from_its_phase(axis, cycles, phase):
    time = np.arange(0.0, 6.0, 0.004)
    command = 0.15 * np.cos(2.0 * np.pi * 0.6 * time) + 0.05 * np.cos(2.0 * np.pi * 0.23 * time)
    asked = Recording.from_arrays("run", time, "torque", command, dict.fromkeys(axis.signals, np.zeros(len(time))))
    recording = simulate(axis.with_effect("cogging", amplitude=0.01, cycles=cycles, phase=phase), asked, seed=1)
    nominal, data = prepare(axis, [recording])
    (found,) = signatures(baseline(Calibrator(nominal, data).uncalibrated(nominal), data), "cogging")
    middle = float(np.mean(recording.signals["arm_angle"]))  # where a sine of a start's period meets the hidden one
    wanted = cycles * middle + phase
    shown = found.start["cycles"] * middle + found.start["phase"]
    assert abs(math.remainder(shown - wanted, 2.0 * math.pi)) < 0.6
    assert found.start["cycles"] == pytest.approx(cycles, abs=1.0)
    assert found.start["amplitude"] == pytest.approx(0.01, rel=0.5)
