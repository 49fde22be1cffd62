"""An arm unlike the thesis's: small, driven by voltage through gears of 48, shown by its tip instead of strain gages."""

from __future__ import annotations

import pytest

from flexarm_env import Arm, diagnose, simulate

FRICTION = {"coulomb": {"torque": 0.02}, "viscous": {"coefficient": 0.01}, "stiction": {"extra": 0.005}}
#: What its constants are over what the model says.
WRONG = {
    "drive.torque_constant": 0.93,
    "beam.mass_per_length": 1.1,
    "beam.bending_stiffness": 0.88,
    "hub.inertia": 1.12,
    "effects.coulomb.torque": 1.07,
    "effects.viscous.coefficient": 0.9,
}


@pytest.fixture(scope="module")
def model() -> Arm:
    arm = Arm.load("cu-flexible").with_values({"drive.motor_inertia": 5e-7})
    for name, values in FRICTION.items():
        arm = arm.with_effect(name, **values)
    return arm


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "values"),
    [
        ("", {}),
        ("dead_zone", {"width": 0.175}),
        ("cable_stiffness", {"stiffness": 0.0156, "rest_angle": 0.0}),
        ("sensor_offset", {"arm_angle": 0.0, "motor_speed": 0.0, "strain_mid": 0.0, "strain_base": 0.0, "tip_deflection": 0.002}),
    ],
)
def test_what_it_lacks_is_named(model: Arm, effect: str, values: dict[str, float]) -> None:
    machine = model.with_values({path: model.value(path) * factor for path, factor in WRONG.items()})
    machine = machine.with_effect(effect, **values) if effect else machine
    found = diagnose(model, [simulate(machine, kind, rate=200.0, seed=3) for kind in ("pulse", "square", "sweep")])
    assert found.effects == ([effect] if effect else [])
    assert found.verdict == ("effects" if effect else "parameters")
    assert found.error["final"] < 1.2
    for estimate in (e for c in found.ranking if c.accepted for e in c.estimates):
        true = values[estimate.path.rsplit(".", 1)[1]]
        assert estimate.value == pytest.approx(true, rel=0.15, abs=0.05)
