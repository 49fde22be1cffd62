"""What recordings are asked must not depend on their order, nor on effects that are listed and absent."""

from __future__ import annotations

import itertools

import pytest

from flexarm_env import Arm, Recording, compare, fit, simulate
from flexarm_env.effects import catalogue
from flexarm_env.identify.explain.comparison import Comparison

MACHINE = Arm.load("cu-rigid").with_effect("coulomb", torque=0.01)
MODEL = Arm.load("cu-rigid")


@pytest.fixture(scope="module")
def runs() -> list[Recording]:
    return [
        simulate(MACHINE, kind, duration=1.5, rate=200.0, seed=seed) for seed, kind in enumerate(("pulse", "square", "sweep"))
    ]


def figures(found: Comparison) -> dict[tuple[str, str, str], float]:
    return {(row.recording, row.signal, row.part): row.error for row in found.rows}


def test_the_order_of_recordings_changes_no_error(runs):
    expected = figures(compare(MODEL, runs))
    for order in itertools.permutations(runs):
        assert figures(compare(MODEL, order)) == pytest.approx(expected, rel=1e-9, nan_ok=True)


def test_the_order_of_recordings_changes_no_fit(runs):
    one, other = fit(MODEL, runs), fit(MODEL, runs[::-1])
    values = [{estimate.path: estimate.value for estimate in found.estimates} for found in (one, other)]
    assert values[0] == pytest.approx(values[1], rel=1e-3)
    assert one.error["refitted"] == pytest.approx(other.error["refitted"], rel=1e-4)


def test_an_effect_that_is_absent_changes_no_error(runs):
    expected = figures(compare(MODEL, runs[:1]))
    for name, effect in catalogue().items():
        if MODEL.can_have(name) and name not in MODEL.effects:
            listed = figures(compare(MODEL.with_effect(name, **effect.null_values()), runs[:1]))
            assert listed == pytest.approx(expected, rel=0.0, abs=0.0, nan_ok=True), name
