"""The search decides by criteria that are passed to it: another set names effects, or none, with the same fits."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from searches import far_off, scored

from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.criteria import Measure, ThresholdCriteria
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.settings import SETTINGS


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


@pytest.mark.parametrize(("left", "compares"), [(Score(8.9, 19.0), True), (Score(20.0, 200.0), False), (Score(2.9, 300.0), True)])
def test_rivals_are_compared_far_off_only_where_most_is_explained(left, compares):
    assert far_off().criteria.can_compare_rivals(scored(left)) == compares


@pytest.mark.parametrize(("whole_run", "verdict"), [(60.0, "effects"), (258.0, "effects"), (470.0, "unknown")])
def test_where_torque_noise_is_stated_effects_that_worsen_whole_runs_are_not_named(whole_run, verdict):
    """Hidden effects that were found on a pendulum under such noise left less than a tenth of the error of whole runs."""
    names = ("tach_filter", "cable_stiffness")
    found = scored(Score(1.04, whole_run), *names)
    criteria = ThresholdCriteria(Score(3.3, 250.0), Score(1.52, 250.0), False, SETTINGS)
    assert criteria.verdict(names, scored(Score(1.52, 250.0)), found) == verdict
