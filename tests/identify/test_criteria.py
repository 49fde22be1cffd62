"""The search decides by criteria that are passed to it: another set names effects, or none, with the same fits."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.identify.select.criteria import Measure, ThresholdCriteria
from flexarm_env.identify.select.model import Model


@dataclass(frozen=True)
class BICCriteria(ThresholdCriteria):
    """Accept while the Bayesian information criterion of all data falls (Schwarz, Ann. Stat. 6 (1978) 461)."""

    def is_sufficient(self, found: Model) -> bool:
        """No error ends the search: only a criterion that rises does."""
        return False

    def is_worthwhile(self, without: Model, found: Model, measure: Measure) -> bool:
        """Whether the criterion falls."""
        dataset = found.calibration.objective.dataset
        return found.bic(dataset) < without.bic(dataset)

    def explains(self, found: Model) -> bool:
        """Whether effects that lowered the criterion are believed: always."""
        return True


@dataclass(frozen=True)
class NeverCriteria(ThresholdCriteria):
    """Accept nothing."""

    def is_worthwhile(self, without: Model, found: Model, measure: Measure) -> bool:
        """Whether one more effect helps: never."""
        return False

    def is_fully_explained(self, found: Model) -> bool:
        """Whether effects explain the data together: never."""
        return False


@pytest.fixture(scope="module")
def nominal() -> Arm:
    return Arm.load("cu-rigid")


@pytest.fixture(scope="module")
def recording(nominal: Arm) -> Recording:
    return simulate(nominal.with_effect("coulomb", torque=0.05), "square", duration=3.0, rate=100.0, seed=1)


def test_bic_names_the_hidden_effect(nominal, recording):
    found = diagnose(nominal, [recording], jobs=1, criteria=BICCriteria)
    assert (found.verdict, found.effects) == ("effects", ["coulomb"])
    assert found.arm.value("effects.coulomb.torque") == pytest.approx(0.05, rel=0.05)
    assert found.trace[-1]["effects"] == ["coulomb"]


def test_criteria_that_never_accept_name_nothing(nominal, recording):
    found = diagnose(nominal, [recording], jobs=1, criteria=NeverCriteria)
    assert (found.verdict, found.effects, found.equivalent) == ("unknown", [], [])
    assert "accept" not in [step["action"] for step in found.trace]
    assert found.ranking[0].gain > 0.9
    assert not any(candidate.accepted for candidate in found.ranking)
