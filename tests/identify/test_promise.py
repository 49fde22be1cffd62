"""What an effect promises to explain of the forecasts' errors, before anything is fitted."""

from __future__ import annotations

import pytest
from searches import limited, seen_by

from flexarm_env import Arm
from flexarm_env.identify.calibrate.parameters import free_parameters
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.density import first_disturbances, likeliest
from flexarm_env.identify.select.promise import Promise, promises
from flexarm_env.identify.select.starts import candidates
from flexarm_env.identify.settings import SETTINGS


def weighed(nominal: Arm, data: Dataset, names: list[str]) -> list[Promise]:
    prediction = likeliest(nominal, data, first_disturbances(nominal, data))
    return promises(prediction, free_parameters(nominal, nominal, data), names)


def promised(machine: Arm, model: Arm, *names: str) -> dict[str, float]:
    """Gain of each effect, most promising first, over the cost of the model as given."""
    nominal, data = seen_by(machine, model)
    cost = likeliest(nominal, data, first_disturbances(nominal, data)).cost
    return {p.effect: p.gain / cost for p in weighed(nominal, data, list(names) or candidates(nominal, data))}


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


@pytest.mark.parametrize(
    ("model", "effect", "values"),
    [
        ("thesis", "constant_torque", {"torque": 0.05}),
        ("thesis-fem", "strain_lag", {"time": 0.01}),
        ("thesis-fem", "cable_stiffness", {"stiffness": 0.15, "rest_angle": 0.1}),
    ],
)
def test_the_hidden_effect_promises_most(model, effect, values):
    known = Arm.load(model)
    gains = promised(known.with_effect(effect, **values), known)
    assert next(iter(gains)) == effect


def test_what_resembles_the_hidden_effect_may_promise_more_and_not_by_much():
    """A dead zone of the voltage acts as dry friction does while the hub turns."""
    known = Arm.load("cu-rigid")
    gains = promised(known.with_effect("coulomb", torque=0.05), known)
    assert set(list(gains)[:2]) == {"coulomb", "dead_zone"}
    assert gains["coulomb"] > SETTINGS.forecast_searching.near_promise * max(gains.values())


def test_an_arm_that_lacks_nothing_is_promised_little(arm):
    assert max(promised(arm, arm).values(), default=0.0) < 0.1


def test_what_was_weighed_before_does_not_matter(arm):
    """Both add two states to the arm, and an observer's gains for one do not suit the other."""
    nominal, data = seen_by(arm.with_effect("strain_lag", time=0.003), arm)
    alone = weighed(nominal, data, ["strain_lag"])
    beside = weighed(nominal, data, ["root_compliance", "strain_lag"])
    assert alone[0] == next(p for p in beside if p.effect == "strain_lag")


def test_a_small_steady_torque_is_seen_though_observers_hide_it(arm):
    gains = promised(arm.with_effect("base_tilt", torque=0.006, uphill=1.2), arm)
    assert list(gains).index("base_tilt") < 4


@pytest.mark.parametrize("share", [0.9, 0.96])
@pytest.mark.parametrize("size", [1.0, 24.0])
def test_a_limit_below_the_largest_command_is_seen_whatever_the_commands_size(arm, share, size):
    """The same machine, with an amplifier that is commanded in units so many times smaller."""
    machine, model = limited(arm, share, size)
    nominal, data = seen_by(machine, model)
    before, true = (likeliest(a, data, first_disturbances(a, data)).cost for a in (nominal, machine))
    (found,) = weighed(nominal, data, ["saturation"])
    assert found.gain > 0.6 * (before - true)
