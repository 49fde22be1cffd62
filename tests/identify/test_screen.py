"""What an effect explains of a residual, before anything is fitted."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import pytest

from flexarm_env import Arm, simulate
from flexarm_env.effects import Effect
from flexarm_env.identify.data import Data, prepare
from flexarm_env.identify.refit import as_it_is
from flexarm_env.identify.scales import torque_scale
from flexarm_env.identify.screen import (
    SCREENING_LEVELS,
    Base,
    first_start,
    screening_base,
    screening_bases,
    signatures,
    sized,
    unexplained,
)
from flexarm_env.parameters import Parameter


def seen_by(machine: Arm, model: Arm) -> tuple[Arm, Data]:
    recordings = [simulate(machine, kind, duration=4.0, rate=200.0, seed=3) for kind in ("square", "pulse")]
    return prepare(model, recordings)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


def explained(base: Base, *names: str) -> list[float]:
    return [sum(s.explained for s in signatures(base, name)) for name in names]


def test_what_was_tried_before_does_not_matter(arm):
    """Both add two states to the arm, and the feedback's gains for one do not suit the other."""
    machine = arm.with_effect("strain_lag", time=0.003)
    nominal, data = seen_by(machine, arm)
    bases = [screening_base(as_it_is(nominal, data), data) for _ in range(2)]
    alone = explained(bases[0], "strain_lag")[0]
    assert alone > 0.5
    assert explained(bases[1], "root_compliance", "strain_lag")[1] == alone


def test_a_small_steady_torque_is_looked_for_where_feedback_does_not_hide_it(arm):
    machine = arm.with_effect("base_tilt", torque=0.006, uphill=1.2)
    nominal, data = seen_by(machine, arm)
    found = as_it_is(nominal, data)
    scale = torque_scale(nominal, data.runs)
    hidden = screening_base(found, data, SCREENING_LEVELS[:1])
    chosen = screening_base(found, data)
    assert hidden.problem.torque_noise == pytest.approx(SCREENING_LEVELS[0] * scale)
    assert chosen.problem.torque_noise < hidden.problem.torque_noise
    assert explained(chosen, "base_tilt")[0] > 0.2
    assert explained(hidden, "base_tilt")[0] < 0.02


def test_errors_weigh_the_same_from_every_start(arm):
    machine = arm.with_effect("stribeck", extra=0.05, falloff_speed=0.2)
    nominal, data = seen_by(machine, arm)
    other = as_it_is(nominal.with_values({"hub.inertia": 1.2 * nominal.value("hub.inertia")}), data)
    first, second = screening_bases([as_it_is(nominal, data), other], data)
    assert (second.problem.sigma == first.problem.sigma).all()
    assert (second.problem.prior == first.problem.prior).all()
    assert second.problem.torque_noise == first.problem.torque_noise
    assert (second.residual != first.residual).any()


@pytest.mark.parametrize("share", [0.7, 0.9, 0.96])
@pytest.mark.parametrize("size", [1.0, 24.0])
def test_a_limit_below_the_largest_command_is_seen_whatever_the_commands_size(arm, share, size):
    """The same machine, with an amplifier that is commanded in units so many times smaller."""
    drive = arm.constants["drive"]
    values = {"drive.torque_constant": drive["torque_constant"] / size, "drive.limit": drive["limit"] * size}
    model = arm.with_values(values)
    largest = max(
        float(abs(simulate(model, kind, duration=4.0, rate=200.0, seed=3).command).max()) for kind in ("square", "pulse")
    )
    machine = model.with_effect("saturation", limit=share * largest)
    nominal, data = seen_by(machine, model)
    base = screening_base(as_it_is(nominal, data), data)
    before, left = (unexplained(base, r) for r in (base.residual, base.problem.residual_of(machine)))
    most = 1.0 - (left @ left) / (before @ before)
    assert explained(base, "saturation")[0] > 0.6 * most


class Shaped(Effect):
    """Its size is left out of its starts, and one of its parameters has none."""

    name = "shaped"
    equation = "τ = −k (θ − s)"
    parameters: ClassVar = {
        "stiffness": Parameter("N*m/rad", 0.0, 1.0, 0.1, null=0.0),
        "start": Parameter("rad", -1.0, 1.0, 0.2),
    }
    looks_like = "a spring"

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        return [{"start": 0.3}]


def test_a_start_that_leaves_values_out_has_typical_ones(arm):
    known = replace(arm, known=arm.known.extended(Shaped))
    assert first_start(known, "shaped", {}) == {"stiffness": 0.1, "start": 0.3}
    assert sized(known, "shaped", first_start(known, "shaped", {}), 0.5) == {"stiffness": 0.05, "start": 0.3}
