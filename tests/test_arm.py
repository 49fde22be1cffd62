"""The arm's own examples, and what a sensor and an effect ask of it."""

from __future__ import annotations

import doctest
import importlib
from dataclasses import replace

import pytest

from flexarm_env.arm import Arm
from flexarm_env.effects import catalogue
from flexarm_env.errors import InputError

MODULES = ("arm", "arm_file", "arm_text", "linear", "parameters", "units", "sensors.base")


@pytest.mark.parametrize("name", MODULES)
def test_the_examples_in_its_docstrings_are_right(name):
    result = doctest.testmod(importlib.import_module(f"flexarm_env.{name}"))
    assert result.attempted
    assert not result.failed


def test_effects_of_gages_need_any_gage():
    thesis = Arm.load("thesis")
    base_only = replace(thesis, sensors={"arm_angle": thesis.sensors["arm_angle"], "strain_base": thesis.sensors["strain_base"]})
    assert base_only.can_have("strain_lag")
    assert base_only.can_have("strain_drift")
    with pytest.raises(InputError, match="'strain_lag' needs a strain gage, which arm 'cu-flexible' does not have"):
        Arm.load("cu-flexible").with_effect("strain_lag")


def test_one_effect_at_most_pairs_with_all():
    assert [name for name, effect in catalogue().items() if effect.pairs_with_all] == [catalogue().pairing]


def test_null_values_make_an_effect_vanish():
    assert all(effect.absent(effect.null_values()) for effect in catalogue().values())
