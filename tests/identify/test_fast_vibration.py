"""Calibration of a beam whose vibration turns by many periods in a run, so that constants must be found to a thousandth."""

from __future__ import annotations

import pytest

from flexarm_env import Arm, simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import prepare

#: A light beam without friction: 45 Hz while its hub moves.
BEAM = {
    "drive": {
        "input": "voltage",
        "gear_ratio": 57.0,
        "limit": 24.0,
        "torque_constant": 0.079,
        "resistance": 1773.0,
        "motor_inertia": 0.0,
    },
    "hub": {"inertia": 4.4e-4},
    "beam": {"elements": 4, "length": 0.98, "mass_per_length": 9.7e-3, "bending_stiffness": 0.88},
    "sensors": {
        "arm_angle": {"noise": 3.4e-4},
        "strain_base": {"gain": 112.7, "position": 0.075, "noise": 0.0157},
        "strain_mid": {"gain": 112.7, "position": 0.46, "noise": 0.0157},
    },
}


def test_a_payload_beside_a_fast_vibration_is_calibrated_to_the_noise():
    given = Arm.from_table(BEAM, "light beam")
    true = {"beam.mass_per_length": 0.997 * 9.7e-3, "beam.bending_stiffness": 1.00075 * 0.88}
    machine = given.with_values(true).with_effect("payload", mass=1.9e-4)
    nominal, data = prepare(given, [simulate(machine, "sweep", duration=7.0, rate=100.0, seed=1)])
    calibrator = Calibrator(nominal, data)
    found = calibrator.calibrate(nominal.with_effect("payload", mass=1.4e-4))
    assert calibrator.score(found.arm, held_out=False).windows < 1.05
    assert found.arm.effects["payload"]["mass"] == pytest.approx(1.9e-4, rel=0.02)
