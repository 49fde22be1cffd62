"""The search decides by criteria that are passed to it: another set names effects, or none, with the same fits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import pytest

from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.criteria import Criteria, Measure, ThresholdCriteria
from flexarm_env.identify.settings import SETTINGS

#: Held-out samples of two signals: the last 35 % of 3 s at 100 Hz.
SAMPLES = 210


@dataclass(frozen=True)
class BICCriteria(ThresholdCriteria):
    """Accept while the Bayesian information criterion of the held-out part falls (Schwarz, Ann. Stat. 6 (1978) 461).

    Attributes:
        samples: held-out samples, of all signals.
        parameters: of an effect.
    """

    samples: int = SAMPLES
    parameters: int = 1

    def is_sufficient(self, found: Score) -> bool:
        """No error ends the search: only a criterion that rises does."""
        return False

    def is_worthwhile(self, without: Score, found: Score, measure: Measure) -> bool:
        """Whether the criterion falls."""
        removed = self.samples * (without.windows**2 - found.windows**2)
        return removed > self.parameters * math.log(self.samples)

    def explains(self, found: Score) -> bool:
        """Whether all effects together lower the criterion."""
        return self.is_worthwhile(self.refitted, found, lambda s: s.excess)


@dataclass(frozen=True)
class NeverCriteria(ThresholdCriteria):
    """Accept nothing."""

    def is_worthwhile(self, without: Score, found: Score, measure: Measure) -> bool:
        """Whether one more effect helps: never."""
        return False

    def is_fully_explained(self, found: Score) -> bool:
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


def test_the_criterion_falls_by_more_than_its_penalty():
    before, least = Score(1.5, 1.5), math.log(SAMPLES)
    criteria: Criteria = BICCriteria(before, before, True, SETTINGS)
    two: Criteria = partial(BICCriteria, parameters=2)(before, before, True, SETTINGS)
    after = Score(math.sqrt(1.5**2 - 1.5 * least / SAMPLES), 1.5)
    assert criteria.explains(after)
    assert not two.explains(after)
