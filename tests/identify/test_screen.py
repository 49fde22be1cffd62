"""What an effect explains of a residual, before anything is fitted."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import pytest
from searches import limited, seen_by

from flexarm_env import Arm
from flexarm_env.effects import Effect
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.select.signatures import Baseline, baseline, baselines, signatures
from flexarm_env.identify.select.starts import first_start, sized, starts_of
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.parameters import Parameter

LEVELS = SETTINGS.process_noise.screening


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


def explained(base: Baseline, *names: str) -> list[float]:
    return [sum(s.explained for s in signatures(base, name)) for name in names]


def test_what_was_tried_before_does_not_matter(arm):
    """Both add two states to the arm, and the feedback's gains for one do not suit the other."""
    machine = arm.with_effect("strain_lag", time=0.003)
    nominal, data = seen_by(machine, arm)
    bases = [baseline(Calibrator(nominal, data).uncalibrated(nominal), data) for _ in range(2)]
    alone = explained(bases[0], "strain_lag")[0]
    assert alone > 0.5
    assert explained(bases[1], "root_compliance", "strain_lag")[1] == alone


def test_a_small_steady_torque_is_looked_for_where_feedback_does_not_hide_it(arm):
    machine = arm.with_effect("base_tilt", torque=0.006, uphill=1.2)
    nominal, data = seen_by(machine, arm)
    found = Calibrator(nominal, data).uncalibrated(nominal)
    scale = torque_scale(nominal, data.runs)
    hidden = baseline(found, data, LEVELS[:1])
    chosen = baseline(found, data)
    assert hidden.objective.torque_noise == pytest.approx(LEVELS[0] * scale)
    assert chosen.objective.torque_noise < hidden.objective.torque_noise
    assert explained(chosen, "base_tilt")[0] > 0.2
    assert explained(hidden, "base_tilt")[0] < 0.02


def test_errors_weigh_the_same_from_every_start(arm):
    machine = arm.with_effect("stribeck", extra=0.05, falloff_speed=0.2)
    nominal, data = seen_by(machine, arm)
    calibrator = Calibrator(nominal, data)
    other = calibrator.uncalibrated(nominal.with_values({"hub.inertia": 1.2 * nominal.value("hub.inertia")}))
    first, second = baselines([calibrator.uncalibrated(nominal), other], data)
    assert (second.objective.weights.sigma == first.objective.weights.sigma).all()
    assert (second.objective.weights.prior == first.objective.weights.prior).all()
    assert second.objective.torque_noise == first.objective.torque_noise
    assert (second.residual != first.residual).any()


@pytest.mark.parametrize("share", [0.7, 0.9, 0.96])
@pytest.mark.parametrize("size", [1.0, 24.0])
def test_a_limit_below_the_largest_command_is_seen_whatever_the_commands_size(arm, share, size):
    """The same machine, with an amplifier that is commanded in units so many times smaller."""
    machine, model = limited(arm, share, size)
    nominal, data = seen_by(machine, model)
    base = baseline(Calibrator(nominal, data).uncalibrated(nominal), data)
    before, left = (base.unexplained(r) for r in (base.residual, base.objective.residual_of(machine)))
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
        return [{"start": 0.3}, {"start": 0.4}, {"start": 3.0}]


def test_a_start_that_leaves_values_out_has_typical_ones(arm):
    known = replace(arm, known=arm.known.extended(Shaped))
    _, data = seen_by(arm, arm)
    start = first_start(known, "shaped", replace(data, scales={}))
    assert start == {"stiffness": 0.1, "start": 0.3}
    assert sized(known, "shaped", start, 0.5, data) == {"stiffness": 0.05, "start": 0.3}
    shapes = [start["start"] for start in starts_of(known, "shaped", replace(data, scales={"rad": 2.0}))]
    assert shapes == [0.6, 0.8, 1.0]  # in the scale of the data, within the bounds


@pytest.mark.parametrize(
    ("name", "start", "factor", "larger"),
    [
        ("coulomb", {"torque": 0.1}, 3.0, {"torque": pytest.approx(0.3)}),
        ("load_friction", {"coefficient": 0.5}, 10.0, {"coefficient": 0.95}),
        ("constant_torque", {"torque": 0.1}, -2.0, {"torque": -0.2}),
        ("saturation", {"limit": 3.0}, 2.0, {"limit": pytest.approx(15.0 / 7.0)}),  # absent from the peak on
        ("gear_compliance", {"stiffness": 200.0, "damping_time": 1e-3}, 4.0, {"stiffness": 50.0, "damping_time": 1e-3}),
        ("stribeck", {"extra": 0.2, "falloff_speed": 0.3}, 0.5, {"extra": 0.1, "falloff_speed": 0.3}),
    ],
)
def test_an_effect_so_many_times_larger(arm, name, start, factor, larger):
    _, data = seen_by(arm, arm)
    assert sized(arm, name, start, factor, replace(data, scales={})) == larger
