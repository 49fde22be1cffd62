"""The same machine in other sizes: heavier and stronger alike, commanded or gaged in other units. The same is said of all."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, simulate
from flexarm_env.effects import catalogue
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.common_scale import force_power
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.signatures import baseline, signatures
from flexarm_env.identify.select.starts import candidates, starts_of

#: A power of two, so that no digit changes.
FACTOR = 64.0
NAMES = [name for name in catalogue() if catalogue()[name].fitted]


def paths(arm: Arm) -> list[str]:
    """Every value of an arm."""
    found = [f"{section}.{key}" for section, table in arm.constants.items() for key in table]
    found += [f"sensors.{signal}.{key}" for signal, table in arm.sensors.items() for key in table]
    found += [f"effects.{name}.{key}" for name, table in arm.effects.items() for key in table]
    return [path for path in found if math.isfinite(arm.value(path))]


def heavier(arm: Arm) -> Arm:
    """Return the arm with all forces, masses and stiffness larger, and strain gages as much less sensitive."""
    return arm.with_values({p: arm.value(p) * FACTOR ** force_power(arm.parameter(p).unit) for p in paths(arm)})


def commanded_in_other_units(arm: Arm) -> Arm:
    """Return the arm with an amplifier whose commands are larger for the same torque."""
    larger = [p for p in paths(arm) if arm.parameter(p).of_command or p == "drive.limit"]
    constant = arm.constants["drive"]["torque_constant"] / FACTOR
    return arm.with_values({p: arm.value(p) * FACTOR for p in larger} | {"drive.torque_constant": constant})


def gaged_in_other_units(arm: Arm) -> Arm:
    """Return the arm with strain gages that show more volts for the same strain."""
    volts = [p for p in paths(arm) if p.startswith(("sensors.strain", "effects")) and arm.parameter(p).unit.startswith("V")]
    return arm.with_values({p: arm.value(p) * FACTOR for p in volts if not arm.parameter(p).of_command})


@pytest.fixture(scope="module", params=["thesis-fem", "thesis"])
def arm(request) -> Arm:
    """With gears that give way, and with rigid ones."""
    thesis = Arm.load(request.param)
    return replace(thesis, sensors={**thesis.sensors, "tip_deflection": {**thesis.sensors["arm_angle"], "noise": 1e-3}})


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("force", [1e-4, 1e3])
@pytest.mark.parametrize("turn", [1e-2, 1.0])
def test_its_bounds_hold_what_small_and_large_machines_have(name, force, turn):
    """A small joint has 1e-4 of the torque of the thesis, and a screw of 1 m for a radian a hundredth of its turn."""
    turns = {"rad/s": 1, "1/rad": -1, "N*m/rad": -1, "rad/N/m": 1, "N*m*s": -1}
    for key, p in catalogue()[name].parameters.items():
        size = p.typical * force ** force_power(p.unit) * turn ** (1 if p.of_travel else turns.get(p.unit, 0))
        assert p.low <= size <= p.high, (key, size)
        assert p.null != math.inf or p.low <= 1e-2 * size, "a spring may be a hundred times softer than is typical"
        assert p.unit != "rad/N/m" or p.high >= 1e2 * size, "and a compliance as much larger"


@pytest.mark.parametrize("name", NAMES)
def test_it_moves_as_a_lighter_one_does(arm, name):
    if name not in arm.effects and not arm.can_have(name):
        pytest.skip(f"arm '{arm.name}' cannot have it")
    machine = arm if name in arm.effects else arm.with_effect(name)
    one, other = (simulate(a, "square", duration=2.0, rate=200.0, seed=1) for a in (machine, heavier(machine)))
    assert np.array_equal(one.command, other.command)
    for signal, readings in one.signals.items():
        assert other.signals[signal] == pytest.approx(readings, abs=1e-6)


@pytest.mark.parametrize("resized", [heavier, commanded_in_other_units, gaged_in_other_units])
def test_effects_explain_what_they_do_at_the_thesis_s_size(arm, resized: Callable[[Arm], Arm]):
    machine = arm.with_effect("constant_torque", torque=0.025)
    found = []
    for model, hidden in ((arm, machine), (resized(arm), resized(machine))):
        nominal, data = prepare(model, [simulate(hidden, kind, duration=3.0, rate=200.0, seed=3) for kind in ("square", "pulse")])
        base = baseline(Calibrator(nominal, data).uncalibrated(nominal), data)
        names = [n for n in candidates(nominal, data) if model.known[n].fitted]
        starts = {n: [nominal.with_effect(n, **s) for s in starts_of(nominal, n, data)] for n in names}
        found.append((starts, {n: sum(s.explained for s in signatures(base, n)) for n in names}))
    (starts, explained), (other_starts, other_explained) = found
    assert len(explained) > 20
    assert max(explained.values()) > 0.02
    for name, arms in starts.items():
        for one, other in zip(arms, other_starts[name], strict=True):
            for key, value in resized(one).effects[name].items():
                assert other.effects[name][key] == pytest.approx(value, rel=1e-9), f"{name}.{key}"
        assert other_explained[name] == pytest.approx(explained[name], abs=1e-3), name
