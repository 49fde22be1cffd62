"""Gravity on a tilted base turns the hub, and bends the beam and whatever hangs at its tip."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env.arm import Arm

TORQUE, UPHILL = 0.1, -1.2


@pytest.mark.parametrize(
    ("density", "tip_mass", "payload", "accuracy"),
    [(0.42381, 0.0, 0.0, 1e-2), (0.42381, 0.1, 0.0, 1e-2), (0.42381, 0.0, 0.3, 5e-3), (1e-5, 0.3, 0.0, 1e-5)],
)
def test_a_held_arm_hangs_as_a_cantilever_does(density, tip_mass, payload, accuracy):
    """Moment at x: g sin α (ρ (L − x)²/2 + m (L − x)). Six elements give that of an even load to h²/12."""
    held = replace(Arm.load("thesis-fem"), effects={}).with_effect("coulomb", torque=1.0).with_effect("beam_damping", time=0.03)
    held = held.with_values({"beam.mass_per_length": density, "beam.tip_mass": tip_mass}).with_effect("payload", mass=payload)
    plant = held.with_effect("base_tilt", torque=TORQUE, uphill=UPHILL).plant(0.005)
    readings = dict(zip(plant.signals, plant.replay(np.zeros(6000))[-1], strict=True))
    length, turn = held.value("beam.length"), TORQUE * np.sin(plant.physical()[0] - UPHILL)
    for signal in ("strain_base", "strain_mid"):
        left = length - held.sensors[signal]["position"]
        share = density * left**2 / 2.0 + (tip_mass + payload) * left
        share /= density * length**2 / 2.0 + tip_mass * length
        assert readings[signal] / held.sensors[signal]["gain"] == pytest.approx(turn * share, rel=accuracy)


def test_a_rigid_arm_only_feels_it_at_the_hub():
    rigid = Arm.load("emps").without_effect("constant_torque")
    assert "beam" not in rigid.constants
    pulled = rigid.with_effect("base_tilt", torque=200.0, uphill=-np.pi / 2)
    pushed = rigid.with_effect("constant_torque", torque=200.0)
    ends = [arm.plant(0.001).replay(np.zeros(20))[-1, 0] for arm in (pulled, pushed)]
    assert ends[0] == pytest.approx(ends[1], rel=1e-6)
    assert abs(ends[0]) > 1e-6
