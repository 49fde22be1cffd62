"""Effects that repeat with the angle start from the phase that the recordings show."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.signatures import baseline, signatures
from flexarm_env.identify.select.starts import shows_part_of_period

DRIVE = {"input": "torque", "limit": 4.0, "gear_ratio": 1.0}
SENSORS = {"arm_angle": {"resolution": 1e-4}, "motor_speed": {"noise": 0.02}}


@pytest.fixture(scope="module")
def axis() -> Arm:
    viscous = {"viscous": {"coefficient": 0.05}}
    return Arm.from_table({"drive": DRIVE, "hub": {"inertia": 0.02}, "effects": viscous, "sensors": SENSORS}, "axis")


def recorded(arm: Arm) -> Recording:
    time = np.arange(0.0, 6.0, 0.004)
    command = 0.15 * np.cos(2.0 * np.pi * 0.6 * time) + 0.05 * np.cos(2.0 * np.pi * 0.23 * time)
    asked = Recording.from_arrays("run", time, "torque", command, dict.fromkeys(arm.signals, np.zeros(len(time))))
    return simulate(arm, asked, seed=1)


@pytest.mark.parametrize("phase", [-2.4, -0.7, 0.8, 2.2])
@pytest.mark.parametrize("cycles", [9.0, 9.5])
def test_cogging_starts_from_its_phase(axis, cycles, phase):
    recording = recorded(axis.with_effect("cogging", amplitude=0.01, cycles=cycles, phase=phase))
    nominal, data = prepare(axis, [recording])
    (found,) = signatures(baseline(Calibrator(nominal, data).uncalibrated(nominal), data), "cogging")
    middle = float(np.mean(recording.signals["arm_angle"]))  # where a sine of a start's period meets the hidden one
    wanted = cycles * middle + phase
    shown = found.start["cycles"] * middle + found.start["phase"]
    assert abs(math.remainder(shown - wanted, 2.0 * math.pi)) < 0.6
    assert found.start["cycles"] == pytest.approx(cycles, abs=1.0)
    assert found.start["amplitude"] == pytest.approx(0.01, rel=0.5)


@pytest.mark.parametrize("uphill", [-2.4, -0.7, 0.8, 2.3])
def test_a_tilt_starts_from_its_direction(axis, uphill):
    """Between two directions, a stop or a cable would explain more than either of them."""
    without = axis.without_effect("viscous")
    recording = recorded(without.with_effect("base_tilt", torque=0.003, uphill=uphill))
    nominal, data = prepare(without, [recording])
    (found,) = signatures(baseline(Calibrator(nominal, data).uncalibrated(nominal), data), "base_tilt")
    assert abs(math.remainder(found.start["uphill"] - uphill, 2.0 * math.pi)) < 0.6
    assert found.start["torque"] == pytest.approx(0.003, rel=0.5)


@pytest.mark.parametrize(
    ("effect", "parameters", "is_part"),
    [
        ("cogging", {"cycles": 3.0}, False),
        ("position_friction", {"cycles": 1.5}, True),
        ("base_tilt", {}, True),
        ("tach_ripple", {}, False),  # of the motor's angle
        ("kinematic_error", {}, False),
    ],
)
def test_only_a_slow_sine_of_the_angle_shows_part_of_its_period(effect, parameters, is_part):
    link = {"mass": 0.5, "centre": 0.2, "inertia": 0.02}
    soft = {"joint": {"stiffness": 50.0}, "link": link, "drive": DRIVE | {"motor_inertia": 0.01}, "sensors": SENSORS}
    without = Arm.from_table(soft, "soft")
    typical = {key: p.typical for key, p in without.known[effect].parameters.items()}
    arm = without.with_effect(effect, **typical | parameters)
    time = np.arange(0.0, 2.0, 0.004)
    turned = {name: 1.5 * np.sin(np.pi * time) if name == "arm_angle" else np.zeros(len(time)) for name in arm.signals}
    _, data = prepare(arm, [Recording.from_arrays("run", time, "torque", np.cos(time), turned)])
    assert shows_part_of_period(arm, effect, data) is is_part
