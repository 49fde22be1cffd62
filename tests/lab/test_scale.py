"""Sliders reach what a parameter may be."""

from __future__ import annotations

import math

import pytest

from flexarm_env.effects import catalogue
from flexarm_env.lab.scale import STEPS, scale_of

EVERY = [(name, key) for name, effect in catalogue().items() if effect.fitted for key in effect.parameters]


@pytest.mark.parametrize(("name", "key"), EVERY, ids=lambda x: x)
def test_every_position_is_allowed_and_comes_back(name, key):
    parameter = catalogue()[name].parameters[key]
    for value in (parameter.typical, min(50.0 * abs(parameter.typical), parameter.high)):
        scale = scale_of(parameter, value, parameter.typical)
        reached = [scale.value(position) for position in range(STEPS + 1)]
        assert all(parameter.low <= x <= parameter.high and math.isfinite(x) for x in reached)
        assert reached == sorted(reached)
        assert scale.low <= value <= scale.high
        assert scale.value(scale.position(value)) == pytest.approx(value, rel=1e-3)


def test_what_is_absent_at_zero_can_be_dragged_to_zero():
    scale = scale_of(catalogue()["backlash"].parameters["gap"], 0.06, 0.03)
    assert scale.value(0) == 0.0
    assert scale.high >= 0.12
